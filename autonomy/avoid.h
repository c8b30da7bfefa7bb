// Obstacle avoidance, always first: how far the way ahead is free, and how fast one may drive towards what is there.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/footprint.h"

namespace merlin {

struct AvoidConfig {
  double margin_m = 0.08;                  // [0, 2] kept free on either side of the car
  double height_min_m = 0.08;              // [0, 2] lower points are floor
  double height_max_m = 0.6;               // [0, 5] higher ones pass over the mast; guess
  int points_min = 4;                      // [1, 1000] fewer points in the way are noise; guess
  double stop_gap_m = 0.5;                 // [0.05, 5] the car stands with at least this free before its front
  double deceleration_m_s2 = 0.5;          // [0.05, 5] braking it plans with; the car can do 2
  double hold_s = 0.5;                     // [0, 10] an obstacle that drops out of sight is believed this long
  int saturated_min = 30;                  // [1, 1e5] saturated pixels straight ahead that mean: something close
  double saturated_half_angle_rad = 0.15;  // [0, 1.6] straight ahead
  double aside_max_rad = 0.2;  // [0, 1.6] a camera turned farther to a side does not see the way; half its view
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
  v("saturated_min", c.saturated_min, {1.0, 1e5});
  v("saturated_half_angle_rad", c.saturated_half_angle_rad, {0.0, 1.6});
  v("aside_max_rad", c.aside_max_rad, {0.0, 1.6});
}

class Avoid {
 public:
  Avoid(const Footprint& footprint, const AvoidConfig& config) : footprint_(footprint), config_(config) {}

  // Way the car can drive along the path (points of its base_link to be, in the base frame, in order, from the origin
  // on) until its footprint, turned along the path, touches something. Nothing: no obstacle seen on it. Zero: something is too close
  // to measure, or the camera looks aside.
  std::optional<double> FreeWay_m(const Observation& observation, std::span<const Eigen::Vector2d> path_base);

  // The fastest speed from which the car, braking as planned, still stands stop_gap_m before the obstacle.
  double SpeedLimit_m_s(std::optional<double> free_way_m) const;

 private:
  std::optional<double> SeenNow_m(const Observation& observation, std::span<const Eigen::Vector2d> path_base) const;
  std::optional<double> WayUntilTouch_m(const Eigen::Vector2d& point_base,
                                        std::span<const Eigen::Vector2d> path_base) const;

  Footprint footprint_;
  AvoidConfig config_;
  struct Sight {
    Time stamp;
    Pose T_odom_base;
    double free_way_m;
  };
  std::optional<Sight> last_;
};

}  // namespace merlin
