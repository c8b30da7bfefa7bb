// The heading: yaw of the car in the world. A compass is absolute but noisy, odometry is smooth but drifts; a Kalman
// filter of one state, the angle between the frames odom and world, joins them (P. Maybeck, "Stochastic models,
// estimation, and control", 1979, chapter 1). Steel bends the field around it: the compass then differs from odometry
// to one side, by more than noise does. Such readings are left out until they agree again.
#pragma once

#include <optional>

#include "robot/base/config.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"

namespace merlin {

struct HeadingConfig {
  double compass_sigma_rad = 0.0175;  // [0.001, 1] of one reading: 1 deg; data sheet 0.3-1 deg; guess
  double drift_per_turn = 0.01;       // [0, 1] one sigma of odometry's yaw error per rad turned; guess
  // [0, 1] and by the root of the time. Measured in the twin at 0.5 m/s: 0.0024. Less, so that the bent field of steel is
  // not followed before it is recognised. With 0.0003 a true compass was taken for bent, and left out for half a lap.
  double drift_rad_per_sqrt_s = 0.001;
  double bend_memory_s = 1.0;  // [0.05, 100] over which the differences are averaged; guess
  double bend_sigmas = 3.5;    // [1, 100] the field counts as bent from so many sigmas of their average on; guess
  double bend_wait_s = 60.0;   // [0, 1e6] after so long the compass is trusted again: the wheels were wrong
};

template <class Visitor>
void Visit(Visitor& v, HeadingConfig& c) {
  v("compass_sigma_rad", c.compass_sigma_rad, {0.001, 1.0});
  v("drift_per_turn", c.drift_per_turn, {0.0, 1.0});
  v("drift_rad_per_sqrt_s", c.drift_rad_per_sqrt_s, {0.0, 1.0});
  v("bend_memory_s", c.bend_memory_s, {0.05, 100.0});
  v("bend_sigmas", c.bend_sigmas, {1.0, 100.0});
  v("bend_wait_s", c.bend_wait_s, {0.0, 1e6});
}

class Heading {
 public:
  explicit Heading(const HeadingConfig& config) : config_(config) {}
  // A reading of the compass, and the yaw of odometry at the same instant; in the order of stamps.
  void Update(Time stamp, double compass_yaw_rad, double odometry_yaw_rad);
  // Yaw in the world where odometry has this yaw.
  double Yaw_rad(double odometry_yaw_rad) const { return WrapPi(odometry_yaw_rad + offset_rad_); }
  // True where the last reading came from a bent field.
  bool bent() const { return bent_since_.has_value(); }
  // One standard deviation at an instant after the last reading: it grows with time and turns. Infinite before the
  // first.
  double Sigma_rad(Time now, double odometry_yaw_rad) const;

 private:
  double VarianceAt(Time now, double odometry_yaw_rad) const;
  bool IsBent(Time stamp, double difference_rad, double measured_variance);

  HeadingConfig config_;
  bool started_ = false;
  Time stamp_{0};
  double offset_rad_ = 0.0, variance_ = 0.0, odometry_yaw_rad_ = 0.0;
  double difference_rad_ = 0.0;  // of the readings from the filter, averaged
  double averaged_ = 0.0;        // variance of that average, as a share of one reading's
  std::optional<Time> bent_since_;
};

}  // namespace merlin
