// Obstacle avoidance, which comes first: how far the car can drive along its path before it touches something that the
// depth camera sees, and how fast it may drive towards that.
//
// The footprint of the car, widened by a margin, is moved along the path. Every point between the floor and the top of the
// car that it would touch is an obstacle; a few points are taken for noise. An obstacle that drops out of sight is
// remembered for a moment. Saturated pixels tell no distance: what a shorter exposure measured just before counts
// (perception/exposure_control.h). Without one they count as something very close. Nothing is known of what is behind
// the car or beside it: the camera looks ahead.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "autonomy/path_ahead.h"
#include "autonomy/seen_ahead.h"
#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/footprint.h"

namespace merlin {

struct AvoidConfig {
  double margin_m = 0.08;                  // [0, 2] kept free on either side of the car
  double height_min_m = 0.08;              // [0, 2] lower points are floor
  double height_max_m = 0.6;               // [0, 5] higher points are above the mast; guess
  int points_min = 4;                      // [1, 1000] fewer points than this are noise; guess
  double stop_gap_m = 0.5;                 // [0.05, 5] the car stands with at least this free before its front
  double deceleration_m_s2 = 0.5;          // [0.05, 5] braking it plans with; the car can do 2
  double hold_s = 0.5;                     // [0, 10] an obstacle that drops out of sight is believed this long
  double saturated_min_sr = 0.0035;        // [0, 1] solid angle of saturated pixels that counts; 6 cm at 1 m
  double saturated_half_angle_rad = 0.15;  // [0, 1.6] what counts as straight ahead
  double aside_max_s = 1.0;  // [0, 100] with a camera that turns, the car stops where a part of its path was not looked
                             // at for so long...
  double aside_max_m = 0.3;  // [0, 10] ...or while it drove so far
};

template <class Visitor>
void Visit(Visitor& v, AvoidConfig& c) {
  v("margin_m", c.margin_m, {0.0, 2.0});
  v("height_min_m", c.height_min_m, {0.0, 2.0});
  v("height_max_m", c.height_max_m, {0.0, 5.0});
  v("points_min", c.points_min, {1.0, 1000.0});
  v("stop_gap_m", c.stop_gap_m, {0.05, 5.0});
  v("deceleration_m_s2", c.deceleration_m_s2, {0.05, 5.0});
  v("hold_s", c.hold_s, {0.0, 10.0});
  v("saturated_min_sr", c.saturated_min_sr, {0.0, 1.0});
  v("saturated_half_angle_rad", c.saturated_half_angle_rad, {0.0, 1.6});
  v("aside_max_s", c.aside_max_s, {0.0, 100.0});
  v("aside_max_m", c.aside_max_m, {0.0, 10.0});
}

// A slower speed would only let the car creep: where no more is allowed, it halts.
constexpr double kCreep_m_s = 0.03;

class Avoid {
 public:
  Avoid(const Footprint& footprint, const AvoidConfig& config) : footprint_(footprint), config_(config) {}

  // The length of the path that the car can drive until its footprint, turned along the path, touches something.
  // path_base: positions of the base's origin, in the base frame and in driving order, from the present one on.
  // Nothing: no obstacle is seen on the path. Zero: a camera that turns has not looked at all of the path lately, or
  // something is too close to measure: it saturates the shortest exposure, or no exposure within hold_s measured it.
  std::optional<double> FreeDistance_m(const Observation& observation, std::span<const Eigen::Vector2d> path_base);

  // The highest speed from which the car, braking as planned, still stands stop_gap_m before the obstacle. Infinite without
  // one.
  double SpeedLimit_m_s(std::optional<double> free_m) const;

  // Across a path of at least one position, where the car can just still stop: what a camera that turns must look at.
  PathAcross PathToLookAt(std::span<const Eigen::Vector2d> path_base) const;

 private:
  bool SaturatesAhead(const Observation& observation) const;
  std::optional<double> SeenNow_m(std::span<const Point> points_base, std::span<const Eigen::Vector2d> path_base) const;
  std::optional<double> DistanceUntilTouch_m(const Eigen::Vector2d& point_base,
                                             std::span<const Eigen::Vector2d> path_base) const;

  // A free distance as it was seen, and where. Nothing: no obstacle.
  struct Memory {
    Time stamp;
    Pose T_odom_base;
    std::optional<double> free_m;
  };
  bool Holds(const std::optional<Memory>& memory, Time now) const;
  std::optional<double> WhileSaturated_m(const Observation& observation, std::optional<double> seen_m) const;

  Footprint footprint_;
  AvoidConfig config_;
  std::optional<Memory> last_;      // obstacle
  std::optional<Memory> measured_;  // the last look ahead in which nothing saturated
  SeenAhead seen_;                  // by a camera that turns
};

}  // namespace merlin
