// The free space that one frame saw: a small range image, with the length of the shortest ray around each direction.
// With it a later step decides which voxels of a map the rays passed through (slam/map/moved_away.h).
//
//   frame  origin and axes
//   base   the car, as everywhere
//   view   the camera's optical centre; x level along the middle of the rays, z up
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/observation.h"

namespace merlin {

class ClearView {
 public:
  // The shortest ray around a direction.
  struct Reach {
    float length_m = 0.0f;  // 0: outside the view, or a pixel there has no known length
    bool dark = false;      // one of the rays measured nothing, but would have measured a surface nearer than length_m
  };

  ClearView() = default;  // of a frame that saw nothing
  // From all pixels: those with a point, the free, saturated and unknown ones. Rays that point 60 deg or more away from
  // the x axis of the view are left out, and so are those that are not finite.
  explicit ClearView(const Observation& observation);

  Reach Along(const Eigen::Vector3f& p_view) const {
    if (!(p_view.x() > 0.0f)) return {};
    const float across = (p_view.y() / p_view.x() - left_) * per_bin_, up = (p_view.z() / p_view.x() - low_) * per_bin_;
    if (!(across >= 0.0f && across < static_cast<float>(width_) && up >= 0.0f && up < static_cast<float>(height_)))
      return {};
    const int length = lengths_[static_cast<std::size_t>(up) * width_ + static_cast<std::size_t>(across)];
    return {kUnit_m * static_cast<float>(length < 0 ? -length : length), length < 0};
  }
  const Eigen::Matrix3f& R_view_base() const { return R_view_base_; }
  const Eigen::Vector3f& camera_base() const { return camera_base_; }
  float reach_m() const { return reach_m_; }  // the longest ray
  float left() const { return left_; }        // tangents y / x that bound it
  float right() const { return left_ + static_cast<float>(width_) / per_bin_; }

  // visit(field) for all that a view holds, to write and read it (slam/saved_map.h).
  template <class Visitor, class View>
  static void VisitFields(Visitor& visit, View& view) {
    visit(view.R_view_base_), visit(view.camera_base_);
    visit(view.left_), visit(view.low_), visit(view.per_bin_), visit(view.reach_m_);
    visit(view.width_), visit(view.height_), visit(view.lengths_);
  }
  // Holds for every view that was made of an observation, and must hold for one that was read.
  bool IsWhole() const {
    return width_ == 0 ? lengths_.empty() : lengths_.size() % width_ == 0 && lengths_.size() / width_ == height_;
  }

 private:
  static constexpr float kUnit_m = 0.004f;

  Eigen::Matrix3f R_view_base_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f camera_base_{0, 0, 0};
  float left_ = 0.0f, low_ = 0.0f, per_bin_ = 1.0f, reach_m_ = 0.0f;
  std::size_t width_ = 0, height_ = 0;
  std::vector<std::int16_t> lengths_;  // [kUnit_m], row by row; negative: dark
};

}  // namespace merlin
