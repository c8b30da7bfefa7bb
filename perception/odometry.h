// Where the car has gone, from encoder and steering: the car model of the thesis (eq. 3.1-3.5) with signed speed.
#pragma once

#include <deque>
#include <optional>

#include "robot/types/car.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin {

class Odometry {
 public:
  // car: as calibrated, if it is.
  explicit Odometry(const CarDescription& car) : car_(car) {}
  // States in order of stamps.
  void Update(const DriveState& state);
  // Pose of the car at a time between the oldest and newest state kept (about a second); clamped to these.
  // Nothing before the first state.
  std::optional<Pose> At(Time time) const;

 private:
  struct Knot {
    Time stamp;
    Pose T_odom_base;
  };
  CarDescription car_;
  std::optional<DriveState> last_;
  std::deque<Knot> knots_;
};

// The heading: compass (absolute, noisy) and odometry (smooth, drifting) as a Kalman filter of one state, the angle
// between the odometry's frame and the world. Readings that differ from what the wheels lead to expect, all to one side and
// more than noise would, come from a field that steel bends: they are left out until they agree again.
struct HeadingConfig {
  double compass_sigma_rad = 0.0175;     // [0.001, 1] of one reading; 1 deg: noise 0.3-1 deg, guess of the data sheet
  double drift_per_turn = 0.01;          // [0, 1] odometry's yaw error per rad turned; guess
  double drift_rad_per_sqrt_s = 0.0003;  // [0, 1] and over time; guess
  double bend_memory_s = 1.0;            // [0.05, 100] over which the differences are averaged; guess
  double bend_sigmas = 3.5;              // [1, 100] of their average, from which the field counts as bent; guess
  double bend_wait_s = 60.0;  // [0, 1e6] as long it is waited for; then the compass is believed: the wheels were wrong
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
  // A compass yaw and the odometry's yaw at the same instant.
  void Update(Time stamp, double compass_yaw_rad, double odometry_yaw_rad);
  double Yaw_rad(double odometry_yaw_rad) const { return WrapPi(odometry_yaw_rad + offset_rad_); }
  // The last reading came from a bent field.
  bool bent() const { return bent_since_.has_value(); }
  // One sigma at an instant from the last reading on: grows with time and turns. Infinite before the first reading.
  double Sigma_rad(Time now, double odometry_yaw_rad) const;

 private:
  double VarianceAt(Time now, double odometry_yaw_rad) const;
  bool IsBent(Time stamp, double difference_rad, double measured_variance);

  HeadingConfig config_;
  bool started_ = false;
  Time stamp_{0};
  double offset_rad_ = 0.0, variance_ = 0.0, odometry_yaw_rad_ = 0.0;
  double difference_rad_ = 0.0,
         averaged_ = 0.0;  // of readings from the filter: their average, and of how many (squares' sum)
  std::optional<Time> bent_since_;
};

}  // namespace merlin
