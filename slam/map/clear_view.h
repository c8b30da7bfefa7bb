// How far one frame saw: a small range image of its rays, that tells for a place whether the frame looked through it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "perception/observation.h"

namespace merlin {

class ClearView {
 public:
  enum class Look {
    kNone,     // out of sight, hidden, or no ray there that tells
    kThere,    // a surface, about as far as the place
    kThrough,  // every ray there passed through the place and ended well behind it
  };

  ClearView() = default;  // saw nothing
  // The rays from camera_base to the points, and those to the ends of what was free without a point (Observation's
  // free_base). Rays 60 deg or more off their middle, and ends that are not finite, are left out.
  ClearView(std::span<const Point> points_base, std::span<const Eigen::Vector3f> free_base, const Eigen::Vector3f& camera_base);

  Look At(const Eigen::Vector3f& p_base) const { return AtView(R_view_base_ * (p_base - camera_base_)); }
  // The same in the frame of the view: origin in the camera, x along the middle of its rays, y level.
  Look AtView(const Eigen::Vector3f& p_view) const {
    if (!(p_view.x() > 0.0f)) return Look::kNone;
    const float across = (p_view.y() / p_view.x() - left_) * per_bin_, up = (p_view.z() / p_view.x() - low_) * per_bin_;
    if (!(across >= 0.0f && across < static_cast<float>(width_) && up >= 0.0f && up < static_cast<float>(height_))) return Look::kNone;
    const float free_m = free_m_[static_cast<std::size_t>(up) * width_ + static_cast<std::size_t>(across)];
    const float range_m = p_view.norm(), margin_m = kMargin_m + kMarginShare * range_m;
    if (free_m > range_m + margin_m) return Look::kThrough;
    return free_m >= range_m - margin_m ? Look::kThere : Look::kNone;
  }
  const Eigen::Matrix3f& R_view_base() const { return R_view_base_; }
  const Eigen::Vector3f& camera_base() const { return camera_base_; }
  float reach_m() const { return reach_m_; }                                      // the longest ray
  float left() const { return left_; }                                            // tangents y / x that bound it
  float right() const { return left_ + static_cast<float>(width_) / per_bin_; }

 private:
  static constexpr float kMargin_m = 0.1f, kMarginShare = 0.03f;  // a pose's and a range's error; guess

  Eigen::Matrix3f R_view_base_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f camera_base_{0, 0, 0};
  float left_ = 0.0f, low_ = 0.0f, per_bin_ = 1.0f, reach_m_ = 0.0f;
  std::size_t width_ = 0, height_ = 0;
  std::vector<float> free_m_;  // row by row, the shortest of the rays around a place; 0: none
};

}  // namespace merlin
