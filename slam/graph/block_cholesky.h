// Sparse Cholesky factorisation A = L L^T of a symmetric matrix made of small square blocks, one block row a pose.
// Our own, for two reasons. Speed: blocks of a size known to the compiler make it 2 to 5 times as fast on pose graphs
// as CHOLMOD, Eigen's SimplicialLLT or Ceres on top of either (one iteration's factorisation and solution, sphere2500:
// 46 ms; CHOLMOD supernodal 100 with ATLAS and 165 with the reference BLAS, CHOLMOD simplicial 162, Eigen 200;
// manhattan: 2.2, 11, 4.7, 3.9). And the same bits everywhere: CHOLMOD's depend on the BLAS that a system has and on
// that one's threads.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace merlin {

struct BlockIndex {
  int row = 0, column = 0;
};

// Where the blocks of A and L lie: the same for every matrix of one graph, whatever the blocks' size. Everything but
// `place` and `slots` speaks of rows in the order of elimination (approximate minimum degree).
struct BlockPattern {
  // The q-th block under the diagonal of column k of L changes column j of L: j is its row.
  struct Update {
    int column = 0, index = 0;
  };
  std::vector<int> place;                    // of each row in the order of elimination
  std::vector<int> slots;                    // of each pair given: which block under A's diagonal it is
  std::vector<BlockIndex> blocks;            // of A under the diagonal, by column, then row; no two the same
  std::vector<std::vector<int>> below;       // rows of each column of L under its diagonal, ascending
  std::vector<std::vector<Update>> updates;  // of each column of L, in ascending order

  int size() const { return static_cast<int>(place.size()); }
  std::size_t factor_blocks() const;  // of L, diagonal included
};

// pairs: which rows are joined, row != column, in any order, repeated or not; all in [0, size).
BlockPattern MakePattern(int size, std::span<const BlockIndex> pairs);

// A's blocks. The one of a pair (a, b) is stored for the row and column that are eliminated later and earlier.
template <int D>
struct BlockMatrix {
  using Block = Eigen::Matrix<double, D, D>;
  std::vector<Block> diagonal;  // by row as given
  std::vector<Block> off;       // by slot

  explicit BlockMatrix(const BlockPattern& pattern);
  void SetZero();
  // Adds to A's blocks (a, b) and (b, a), the latter transposed.
  void AddOff(const BlockPattern& pattern, std::size_t pair, BlockIndex at, const Block& block);
};

template <int D>
class BlockCholesky {
 public:
  explicit BlockCholesky(const BlockPattern& pattern);  // which must outlive this

  // Of A with its diagonal times (1 + damping). False: not positive definite, as far as double precision can tell.
  bool Factorize(const BlockMatrix<D>& A, double damping);

  // Solves A x = b in place for each column of b, rows as given. After a Factorize that went well.
  void Solve(Eigen::Ref<Eigen::MatrixXd> b) const;

 private:
  using Block = Eigen::Matrix<double, D, D>;
  using Panel = Eigen::Matrix<double, Eigen::Dynamic, D>;  // a column: its diagonal block, then those below

  void Subtract(int from, int index, Panel& column);

  const BlockPattern& pattern_;
  std::vector<Panel> L_;
  std::vector<int> row_in_panel_;
  Panel product_;
};

}  // namespace merlin
