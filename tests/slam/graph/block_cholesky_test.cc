#include "slam/graph/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

namespace merlin {
namespace {

// A random network of `size` rows: a chain, and as many more pairs, some of them twice and in either order.
std::vector<BlockIndex> RandomPairs(int size, std::mt19937& generator) {
  std::vector<BlockIndex> pairs;
  for (int i = 0; i + 1 < size; ++i) pairs.push_back({.row = i, .column = i + 1});
  std::uniform_int_distribution<int> any(0, size - 1);
  for (int i = 0; i < size; ++i) {
    const BlockIndex pair{.row = any(generator), .column = any(generator)};
    if (pair.row != pair.column) pairs.push_back(pair);
  }
  return pairs;
}

template <int D>
struct System {
  BlockPattern pattern;
  BlockMatrix<D> sparse;
  Eigen::MatrixXd dense;

  System(int size, std::mt19937& generator, const std::vector<BlockIndex>& pairs)
      : pattern(MakePattern(size, pairs)), sparse(pattern), dense(Eigen::MatrixXd::Zero(D * size, D * size)) {
    using Block = Eigen::Matrix<double, D, D>;
    std::normal_distribution<double> normal;
    const auto random = [&] { return Block::NullaryExpr([&] { return normal(generator); }).eval(); };
    for (int i = 0; i < size; ++i) Add(i, i, Block::Identity());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [a, b] = pairs[i];
      const Block J_a = random(), J_b = random();
      Add(a, a, J_a.transpose() * J_a);
      Add(b, b, J_b.transpose() * J_b);
      const Block off = J_a.transpose() * J_b;
      sparse.AddOff(pattern, i, pairs[i], off);
      dense.block<D, D>(D * a, D * b) += off;
      dense.block<D, D>(D * b, D * a) += off.transpose();
    }
  }
  void Add(int i, int, const Eigen::Matrix<double, D, D>& block) {
    sparse.diagonal[i] += block;
    dense.block<D, D>(D * i, D * i) += block;
  }
};

template <int D>
void ExpectSolvesAsTheDenseMatrix(int size) {
  std::mt19937 generator(static_cast<unsigned>(size));
  const System<D> system(size, generator, RandomPairs(size, generator));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(D * size, 3);
  for (const double damping : {0.0, 0.5}) {
    Eigen::MatrixXd damped = system.dense;
    damped.diagonal() *= 1.0 + damping;
    BlockCholesky<D> solver(system.pattern);
    ASSERT_TRUE(solver.Factorize(system.sparse, damping));
    Eigen::MatrixXd x = b;
    solver.Solve(x);
    EXPECT_LT((x - damped.ldlt().solve(b)).norm(), 1e-9 * b.norm()) << size << " " << damping;
  }
}

TEST(BlockCholesky, SolvesLikeADenseSolver) {
  for (const int size : {1, 2, 3, 10, 40}) {
    ExpectSolvesAsTheDenseMatrix<1>(size);
    ExpectSolvesAsTheDenseMatrix<3>(size);
    ExpectSolvesAsTheDenseMatrix<6>(size);
  }
}

TEST(BlockCholesky, SolvesAnUnconnectedSystem) {
  std::mt19937 generator(1);
  const System<3> system(4, generator, {{.row = 3, .column = 1}});
  BlockCholesky<3> solver(system.pattern);
  ASSERT_TRUE(solver.Factorize(system.sparse, 0.0));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(12);
  solver.Solve(x);
  EXPECT_LT((system.dense * x - Eigen::VectorXd::Ones(12)).norm(), 1e-12);
}

TEST(BlockCholesky, SolvesAnEmptySystem) {
  const BlockPattern pattern = MakePattern(0, {});
  BlockCholesky<6> solver(pattern);
  EXPECT_TRUE(solver.Factorize(BlockMatrix<6>(pattern), 0.0));
  Eigen::MatrixXd x(0, 1);
  solver.Solve(x);
  EXPECT_EQ(pattern.factor_blocks(), 0u);
}

TEST(BlockCholesky, ReportsAMatrixThatIsNotPositiveDefinite) {
  std::mt19937 generator(2);
  System<3> system(5, generator, RandomPairs(5, generator));
  BlockCholesky<3> solver(system.pattern);
  for (const double bad : {-1e3, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BlockMatrix<3> broken = system.sparse;
    broken.diagonal[2](1, 1) = bad;
    EXPECT_FALSE(solver.Factorize(broken, 0.0)) << bad;
  }
  EXPECT_TRUE(solver.Factorize(system.sparse, 0.0));  // the failure before has no effect
  EXPECT_FALSE(solver.Factorize(BlockMatrix<3>(system.pattern), 0.0));
}

TEST(BlockPattern, OfAChainHasNoMoreBlocksThanTheChain) {
  std::vector<BlockIndex> chain;
  for (int i = 0; i < 99; ++i) chain.push_back({.row = i + 1, .column = i});
  EXPECT_EQ(MakePattern(100, chain).factor_blocks(), 199u);
}

}  // namespace
}  // namespace merlin
