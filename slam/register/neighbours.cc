#include "slam/register/neighbours.h"

#include <limits>
#include <nanoflann.hpp>

namespace merlin {
namespace {

struct Positions {
  std::span<const Eigen::Vector3d> all;
  std::size_t kdtree_get_point_count() const { return all.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const { return all[index][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// The k nearest by distance, then index. nanoflann's own result set keeps, of several equal ones, the one that its tree
// meets first.
class Least {
 public:
  using DistanceType = double;
  Least(std::span<Neighbour> best, double limit_m2) : best_(best), limit_m2_(limit_m2) {}

  bool addPoint(double squared_m2, std::uint32_t index) {
    if (squared_m2 > limit_m2_) return true;
    const Neighbour candidate{squared_m2, index};
    if (full() && !IsLess(candidate, best_.back())) return true;
    std::size_t i = full() ? count_ - 1 : count_++;
    for (; i > 0 && IsLess(candidate, best_[i - 1]); --i) best_[i] = best_[i - 1];
    best_[i] = candidate;
    if (full()) limit_m2_ = best_.back().squared_m2;
    return true;
  }
  // A little more than the limit: equals must reach addPoint, and the tree's bounds are rounded.
  double worstDist() const { return limit_m2_ * (1.0 + 1e-9) + kTiny_m2; }
  bool full() const { return count_ == best_.size(); }
  std::size_t size() const { return count_; }
  void sort() const {}  // nanoflann 1.6 calls it; they are sorted already

 private:
  static constexpr double kTiny_m2 = std::numeric_limits<double>::min();
  static bool IsLess(const Neighbour& a, const Neighbour& b) {
    return a.squared_m2 < b.squared_m2 || (a.squared_m2 == b.squared_m2 && a.index < b.index);
  }
  std::span<Neighbour> best_;
  double limit_m2_;  // of those that can still be added
  std::size_t count_ = 0;
};

}  // namespace

struct Neighbours::Tree {
  using Index =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Positions>, Positions, 3, std::uint32_t>;
  explicit Tree(std::span<const Eigen::Vector3d> positions) : points{positions}, index(3, points, {24}) {}
  std::size_t Find(const Eigen::Vector3d& query, std::span<Neighbour> found, double limit_m2) const {
    Least least(found, limit_m2);
    if (!found.empty()) index.findNeighbors(least, query.data(), {});
    return least.size();
  }
  Positions points;
  Index index;
};

Neighbours::Neighbours(std::span<const Eigen::Vector3d> positions) : tree_(std::make_unique<Tree>(positions)) {}
Neighbours::~Neighbours() = default;

std::optional<Neighbour> Neighbours::Nearest(const Eigen::Vector3d& query, double reach_m) const {
  Neighbour nearest;
  if (!query.allFinite() || tree_->Find(query, {&nearest, 1}, reach_m * reach_m) == 0) return std::nullopt;
  return nearest;
}

std::size_t Neighbours::Nearest(const Eigen::Vector3d& query, std::span<Neighbour> found, double reach_m) const {
  return query.allFinite() ? tree_->Find(query, found, reach_m * reach_m) : 0;
}

}  // namespace merlin
