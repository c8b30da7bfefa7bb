#include "slam/graph/block_cholesky.h"

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <tuple>
#include <utility>

namespace merlin {
namespace {

std::vector<int> OrderOfElimination(int size, std::span<const BlockIndex> pairs) {
  std::vector<Eigen::Triplet<double>> ones;
  for (const auto& [a, b] : pairs) {
    ones.emplace_back(a, b, 1.0);
    ones.emplace_back(b, a, 1.0);
  }
  for (int i = 0; i < size; ++i) ones.emplace_back(i, i, 1.0);
  Eigen::SparseMatrix<double> joined(size, size);
  joined.setFromTriplets(ones.begin(), ones.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(joined, order);
  std::vector<int> place(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) place[order.indices()[i]] = i;
  return place;
}

bool Before(const BlockIndex& a, const BlockIndex& b) { return std::tie(a.column, a.row) < std::tie(b.column, b.row); }

bool Same(const BlockIndex& a, const BlockIndex& b) { return a.row == b.row && a.column == b.column; }

// A column of L has the rows of A's column and of the columns whose first row below the diagonal it is (the elimination
// tree; T. Davis, "Direct methods for sparse linear systems", 2006, section 4.1).
std::vector<std::vector<int>> RowsOfFactor(int size, const std::vector<BlockIndex>& blocks) {
  std::vector<std::vector<int>> below(static_cast<std::size_t>(size)), children(below);
  std::vector<int> seen_by(static_cast<std::size_t>(size), -1);
  auto block = blocks.begin();
  for (int j = 0; j < size; ++j) {
    seen_by[j] = j;
    const auto add = [&](int row) {
      if (std::exchange(seen_by[row], j) != j) below[j].push_back(row);
    };
    for (; block != blocks.end() && block->column == j; ++block) add(block->row);
    for (const int child : children[j]) std::ranges::for_each(below[child], add);
    std::ranges::sort(below[j]);
    if (!below[j].empty()) children[below[j].front()].push_back(j);
  }
  return below;
}

}  // namespace

std::size_t BlockPattern::factor_blocks() const {
  std::size_t count = place.size();
  for (const std::vector<int>& rows : below) count += rows.size();
  return count;
}

BlockPattern MakePattern(int size, std::span<const BlockIndex> pairs) {
  BlockPattern pattern;
  if (size == 0) return pattern;
  pattern.place = OrderOfElimination(size, pairs);
  const auto placed = [&pattern](const BlockIndex& pair) {
    const auto [low, high] = std::minmax({pattern.place[pair.row], pattern.place[pair.column]});
    return BlockIndex{.row = high, .column = low};
  };
  for (const BlockIndex& pair : pairs) pattern.blocks.push_back(placed(pair));
  std::ranges::sort(pattern.blocks, Before);
  const auto repeated = std::ranges::unique(pattern.blocks, Same);
  pattern.blocks.erase(repeated.begin(), repeated.end());
  for (const BlockIndex& pair : pairs)
    pattern.slots.push_back(
        static_cast<int>(std::ranges::lower_bound(pattern.blocks, placed(pair), Before) - pattern.blocks.begin()));
  pattern.below = RowsOfFactor(size, pattern.blocks);
  pattern.updates.resize(pattern.below.size());
  for (int k = 0; k < size; ++k)
    for (int q = 0; q < static_cast<int>(pattern.below[k].size()); ++q)
      pattern.updates[pattern.below[k][q]].push_back({.column = k, .index = q});
  return pattern;
}

template <int D>
BlockMatrix<D>::BlockMatrix(const BlockPattern& pattern)
    : diagonal(pattern.place.size(), Block::Zero()), off(pattern.blocks.size(), Block::Zero()) {}

template <int D>
void BlockMatrix<D>::SetZero() {
  std::ranges::fill(diagonal, Block::Zero());
  std::ranges::fill(off, Block::Zero());
}

template <int D>
void BlockMatrix<D>::AddOff(const BlockPattern& pattern, std::size_t pair, BlockIndex at, const Block& block) {
  const bool as_given = pattern.place[at.row] > pattern.place[at.column];
  Block& sum = off[pattern.slots[pair]];
  if (as_given)
    sum += block;
  else
    sum += block.transpose();
}

template <int D>
BlockCholesky<D>::BlockCholesky(const BlockPattern& pattern) : pattern_(pattern), row_in_panel_(pattern.place.size()) {
  L_.reserve(pattern.below.size());
  for (const std::vector<int>& rows : pattern.below) L_.emplace_back(D * (1 + rows.size()), D);
}

// Subtracts from a later column of L the outer product of the blocks of an earlier one, from its index-th block on.
template <int D>
void BlockCholesky<D>::Subtract(int from, int index, Panel& column) {
  const Panel& earlier = L_[from];
  const std::vector<int>& rows = pattern_.below[from];
  const auto first = earlier.template middleRows<D>(D * (index + 1));
  const int height = static_cast<int>(rows.size()) - index;
  product_.resize(D * height, D);
  product_.noalias() = earlier.bottomRows(D * height).lazyProduct(first.transpose());
  for (int i = 0; i < height; ++i)
    column.template middleRows<D>(D * row_in_panel_[rows[index + i]]) -= product_.template middleRows<D>(D * i);
}

template <int D>
bool BlockCholesky<D>::Factorize(const BlockMatrix<D>& A, double damping) {
  std::vector<int> row_at(pattern_.place.size());
  for (int i = 0; i < pattern_.size(); ++i) row_at[pattern_.place[i]] = i;
  std::size_t slot = 0;
  for (int j = 0; j < pattern_.size(); ++j) {
    Panel& column = L_[j];
    const std::vector<int>& below = pattern_.below[j];
    row_in_panel_[j] = 0;
    for (std::size_t q = 0; q < below.size(); ++q) row_in_panel_[below[q]] = static_cast<int>(q) + 1;

    column.setZero();
    column.template topRows<D>() = A.diagonal[row_at[j]];
    column.template topRows<D>().diagonal() *= 1.0 + damping;
    for (; slot < pattern_.blocks.size() && pattern_.blocks[slot].column == j; ++slot)
      column.template middleRows<D>(D * row_in_panel_[pattern_.blocks[slot].row]) = A.off[slot];
    for (const auto& [from, index] : pattern_.updates[j]) Subtract(from, index, column);

    const Eigen::LLT<Block> llt(column.template topRows<D>());
    const Block L_jj = llt.matrixL();
    if (llt.info() != Eigen::Success || !(L_jj.diagonal().minCoeff() > 0.0) || !L_jj.allFinite()) return false;
    column.template topRows<D>() = L_jj;
    const Block inverse = L_jj.template triangularView<Eigen::Lower>().solve(Block::Identity());
    const int height = D * static_cast<int>(below.size());
    product_.resize(height, D);
    product_.noalias() = column.bottomRows(height).lazyProduct(inverse.transpose());
    column.bottomRows(height) = product_;
  }
  return true;
}

template <int D>
void BlockCholesky<D>::Solve(Eigen::Ref<Eigen::MatrixXd> b) const {
  Eigen::MatrixXd x(b.rows(), b.cols());
  const auto part = [&x](int j) { return x.middleRows<D>(D * j); };
  for (int i = 0; i < pattern_.size(); ++i) part(pattern_.place[i]) = b.middleRows<D>(D * i);
  for (int j = 0; j < pattern_.size(); ++j) {  // L y = b
    L_[j].template topRows<D>().template triangularView<Eigen::Lower>().solveInPlace(part(j));
    for (std::size_t q = 0; q < pattern_.below[j].size(); ++q)
      part(pattern_.below[j][q]) -= L_[j].template middleRows<D>(D * (q + 1)).lazyProduct(part(j));
  }
  for (int j = pattern_.size() - 1; j >= 0; --j) {  // L^T x = y
    for (std::size_t q = 0; q < pattern_.below[j].size(); ++q)
      part(j) -= L_[j].template middleRows<D>(D * (q + 1)).transpose().lazyProduct(part(pattern_.below[j][q]));
    L_[j].template topRows<D>().template triangularView<Eigen::Lower>().transpose().solveInPlace(part(j));
  }
  for (int i = 0; i < pattern_.size(); ++i) b.middleRows<D>(D * i) = part(pattern_.place[i]);
}

template struct BlockMatrix<1>;
template struct BlockMatrix<3>;
template struct BlockMatrix<6>;
template class BlockCholesky<1>;
template class BlockCholesky<3>;
template class BlockCholesky<6>;

}  // namespace merlin
