// How far one frame saw: a small range image of its rays, by which a map is asked what they passed through.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "perception/observation.h"

namespace merlin {

class ClearView {
 public:
  // The shortest ray of all around a direction.
  struct Reach {
    float length_m = 0.0f;  // 0: outside the view, or a pixel there does not tell
    bool dark = false;      // one of them measured nothing, but would have, had something stood before the length
  };

  ClearView() = default;  // saw nothing
  // Of all pixels: those with a point, the free, saturated and unknown ones. Rays 60 deg or more off the level direction in which
  // they look on the whole are left out, and what is not finite.
  explicit ClearView(const Observation& observation);

  // p_view: in the frame of the view, with its origin in the camera, x level along the view, z up as the base's.
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

 private:
  static constexpr float kUnit_m = 0.004f;

  Eigen::Matrix3f R_view_base_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f camera_base_{0, 0, 0};
  float left_ = 0.0f, low_ = 0.0f, per_bin_ = 1.0f, reach_m_ = 0.0f;
  std::size_t width_ = 0, height_ = 0;
  std::vector<std::int16_t> lengths_;  // [kUnit_m], row by row; negative: dark
};

}  // namespace merlin
