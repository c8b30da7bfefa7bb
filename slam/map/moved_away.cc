#include "slam/map/moved_away.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace merlin {
namespace {

constexpr double kFloor_m = 0.06;  // and what stands no higher is not cleared away by driving over it
constexpr float kBlock_m = 1.0f;  // square columns of voxels that are in sight, or not, together

constexpr int kMost = 2, kLeast = -3;

// Evidence that something is there, as an occupancy grid's log odds: two for each frame that sees it, one less for each
// that looks through, bounded so that three of these outweigh whatever was before.
int Weighed(int evidence, ClearView::Look look) {
  if (look == ClearView::Look::kThere) return std::min(evidence + 2, kMost);
  if (look == ClearView::Look::kThrough) return std::max(evidence - 1, kLeast);
  return evidence;
}

// The voxels of a column lie next to each other.
struct Block {
  Eigen::Vector3f middle{0, 0, 0};  // of its points in the plane, at height 0
  std::size_t begin = 0, end = 0;
};

struct Blocks {
  std::vector<std::size_t> voxels;      // their indices, block by block
  std::vector<Eigen::Vector3f> points;  // their means, in the same order
  std::vector<Block> blocks;
};

Blocks InBlocks(std::span<const Voxel> voxels) {
  const auto column = [&](std::size_t i) {
    return std::pair(std::floor(voxels[i].mean.x() / kBlock_m), std::floor(voxels[i].mean.y() / kBlock_m));
  };
  Blocks out;
  out.voxels.resize(voxels.size());
  std::iota(out.voxels.begin(), out.voxels.end(), std::size_t{0});
  std::ranges::stable_sort(out.voxels, {}, column);
  for (std::size_t i = 0; i < out.voxels.size(); ++i) {
    const auto [x, y] = column(out.voxels[i]);
    if (i == 0 || column(out.voxels[i - 1]) != std::pair(x, y))
      out.blocks.push_back({.middle = {(x + 0.5f) * kBlock_m, (y + 0.5f) * kBlock_m, 0.0f}, .begin = i, .end = i});
    ++out.blocks.back().end;
    out.points.push_back(voxels[out.voxels[i]].mean);
  }
  return out;
}

// False only for blocks of which nothing is in sight. The view is level, or nearly so.
bool MayBeSeen(const Eigen::Vector3f& middle_view, const ClearView& view) {
  constexpr float kRadius_m = 0.75f * kBlock_m;
  const float x = middle_view.x(), y = middle_view.y();
  return x > -kRadius_m && x < view.reach_m() + kRadius_m &&
         y - view.right() * x < kRadius_m * std::hypot(1.0f, view.right()) &&
         view.left() * x - y < kRadius_m * std::hypot(1.0f, view.left());
}

class Evidence {
 public:
  explicit Evidence(std::span<const Voxel> voxels) : all_(InBlocks(voxels)), weighed_(voxels.size(), 0) {}

  void Look(const ClearView& view, const Eigen::Isometry3f& T_base_map) {
    const Eigen::Matrix3f R = view.R_view_base() * T_base_map.linear();
    const Eigen::Vector3f t = view.R_view_base() * (T_base_map.translation() - view.camera_base());
    for (const Block& block : all_.blocks) {
      if (!MayBeSeen(R * block.middle + t, view)) continue;
      for (std::size_t i = block.begin; i < block.end; ++i) weighed_[i] = Weighed(weighed_[i], view.AtView(R * all_.points[i] + t));
    }
  }

  void Sweep(const Eigen::AlignedBox3f& car_base, const Eigen::Isometry3f& T_base_map) {
    const float near_m = kBlock_m + car_base.max().head<2>().norm();
    for (const Block& block : all_.blocks) {
      if ((T_base_map * block.middle).head<2>().norm() > near_m) continue;
      for (std::size_t i = block.begin; i < block.end; ++i)
        if (car_base.contains(T_base_map * all_.points[i])) weighed_[i] = kLeast;
    }
  }

  std::vector<bool> Gone() const {
    std::vector<bool> gone(weighed_.size());
    for (std::size_t i = 0; i < weighed_.size(); ++i) gone[all_.voxels[i]] = weighed_[i] < 0;
    return gone;
  }

 private:
  Blocks all_;
  std::vector<int> weighed_;  // in the order of the blocks' voxels
};

// What the car surely fills, off the floor.
Eigen::AlignedBox3f Filled(const Footprint& footprint) {
  const Eigen::Vector3d low(0.0, -footprint.half_width_m, kFloor_m), high(footprint.front_m, footprint.half_width_m, footprint.height_m);
  return {low.cast<float>(), high.cast<float>()};
}

}  // namespace

std::vector<bool> MovedAway(std::span<const Voxel> voxels, std::span<const Keyframe> keyframes, const Footprint& footprint) {
  Evidence evidence(voxels);
  const Eigen::AlignedBox3f car_base = Filled(footprint);
  for (const Keyframe& keyframe : keyframes) {
    for (const Sight& sight : keyframe.sights)
      evidence.Look(sight.view, (keyframe.T_map_base * sight.T_keyframe_base).inverse().cast<float>());
    if (!car_base.isEmpty()) evidence.Sweep(car_base, keyframe.T_map_base.inverse().cast<float>());
  }
  return evidence.Gone();
}

}  // namespace merlin
