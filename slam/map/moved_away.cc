#include "slam/map/moved_away.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace merlin {
namespace {

constexpr float kBlock_m = 1.0f;         // edge of the square columns of voxels that are tested for visibility together
constexpr float kFloor_m = 0.06f;        // points up to this height may be floor
constexpr int kMost = 2, kLeast = -3;    // bounds of a voxel's evidence
constexpr float kObliqueMin = 0.15f;     // cosine; below it the error of a pose shows what is behind the surface
constexpr float kObliqueDarkMin = 0.3f;  // cosine; below it dark surfaces return too little. Black rubber: albedo 0.07
constexpr float kRange_m = 0.05f, kRangeShare = 0.03f, kPose_m = 0.05f;  // errors; guess
constexpr float kBody_m = 0.04f;  // the error of a pose, by which the car is taken narrower than its footprint
constexpr float kReach_m = 0.1f;  // of the car's middle, to the front and rear: the distance of two key frames

enum class Finding { kNothing, kOccupied, kFree };

// Cosine of the angle between a surface's normal and the ray to it. Without a normal the surface counts as facing the
// camera, unless it may be floor.
float CosineOf(const Eigen::Vector3f& normal, const Eigen::Vector3f& ray, const Eigen::Vector3f& point_map) {
  if (normal.isZero()) return point_map.z() < kFloor_m ? 0.0f : kObliqueDarkMin;
  return std::abs(normal.dot(ray)) / ray.norm();
}

Finding Find(const ClearView::Reach& reach, float range_m, float cosine) {
  if (reach.length_m == 0.0f || cosine < kObliqueMin || (reach.dark && cosine < kObliqueDarkMin))
    return Finding::kNothing;
  const float margin_m = kRange_m + kRangeShare * range_m + kPose_m / cosine;
  if (reach.length_m > range_m + margin_m) return Finding::kFree;
  return !reach.dark && reach.length_m >= range_m - margin_m ? Finding::kOccupied : Finding::kNothing;
}

// Evidence that a voxel is occupied, like the log odds of an occupancy grid: two more for each view of it, one less for
// each view through it. The bounds let three views through it outweigh everything before.
int Weighed(int evidence, Finding finding) {
  if (finding == Finding::kOccupied) return std::min(evidence + 2, kMost);
  if (finding == Finding::kFree) return std::max(evidence - 1, kLeast);
  return evidence;
}

// A column of voxels: a range in Blocks::voxels.
struct Block {
  Eigen::Vector3f middle{0, 0, 0};  // of its points in the plane, at height 0
  std::size_t begin = 0, end = 0;
};

struct Blocks {
  std::vector<std::size_t> voxels;      // their indices, block by block; in the same order:
  std::vector<Eigen::Vector3f> points;  // their means
  std::vector<Eigen::Vector3f> normals;
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
    out.normals.push_back(voxels[out.voxels[i]].normal);
  }
  return out;
}

// False only for blocks that lie outside the view. The view is level, or nearly so.
bool MayBeSeen(const Eigen::Vector3f& middle_view, const ClearView& view) {
  constexpr float kRadius_m = 0.75f * kBlock_m;
  const float x = middle_view.x(), y = middle_view.y();
  return x > -kRadius_m && x < view.reach_m() + kRadius_m &&
         y - view.right() * x < kRadius_m * std::hypot(1.0f, view.right()) &&
         view.left() * x - y < kRadius_m * std::hypot(1.0f, view.left());
}

class Evidence {
 public:
  explicit Evidence(std::span<const Voxel> voxels)
      : all_(InBlocks(voxels)), weighed_(voxels.size(), kMost) {}  // a point fell in: seen

  void Add(const ClearView& view, const Eigen::Isometry3f& T_base_map) {
    const Eigen::Matrix3f R = view.R_view_base() * T_base_map.linear();
    const Eigen::Vector3f t = view.R_view_base() * (T_base_map.translation() - view.camera_base());
    const Eigen::Vector3f camera_map = T_base_map.inverse() * view.camera_base();
    for (const Block& block : all_.blocks) {
      if (!MayBeSeen(R * block.middle + t, view)) continue;
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const ClearView::Reach reach = view.Along(R * all_.points[i] + t);
        if (reach.length_m == 0.0f) continue;
        const Eigen::Vector3f ray = all_.points[i] - camera_map, &normal = all_.normals[i];
        weighed_[i] = Weighed(weighed_[i], Find(reach, ray.norm(), CosineOf(normal, ray, all_.points[i])));
      }
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

// The volume that the middle of the car sweeps, above the floor. The car's front may go under something; what reaches
// its middle would have hit the mast of the camera.
Eigen::AlignedBox3f MiddleOf(const Footprint& footprint) {
  const auto half_m = static_cast<float>(footprint.half_width_m) - kBody_m;
  return {Eigen::Vector3f(-kReach_m, -half_m, kFloor_m),
          Eigen::Vector3f(kReach_m, half_m, static_cast<float>(footprint.height_m))};
}

struct ViewInMap {
  const PlacedView* placed;
  Pose T_map_base;
};

std::vector<ViewInMap> InOrderOfTime(std::span<const Keyframe> keyframes) {
  std::vector<ViewInMap> views;
  for (const Keyframe& keyframe : keyframes)
    for (const PlacedView& placed : keyframe.views)
      views.push_back({&placed, keyframe.T_map_base * placed.T_keyframe_base});
  std::ranges::stable_sort(views, {}, [](const ViewInMap& view) { return view.placed->stamp; });
  return views;
}

}  // namespace

std::vector<bool> MovedAway(std::span<const Voxel> voxels, std::span<const Keyframe> keyframes,
                            const Footprint& footprint) {
  Evidence evidence(voxels);
  const Eigen::AlignedBox3f car_base = MiddleOf(footprint);
  for (const ViewInMap& view : InOrderOfTime(keyframes)) {
    const Eigen::Isometry3f T_base_map = view.T_map_base.inverse().cast<float>();
    evidence.Add(view.placed->view, T_base_map);
    if (!car_base.isEmpty()) evidence.Sweep(car_base, T_base_map);
  }
  return evidence.Gone();
}

}  // namespace merlin
