// Wheel odometry: the car's pose since the first reading, from encoder counts and steering angle. Between two readings
// the rear axle's middle moves on a circle; readings of up to a second ago are kept, so that a frame can be given the
// pose at its stamp. The model is that of "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras
// combination", thesis, University of Siegen, about 2011, eq. 3.1-3.5, with signed speed.
//
//   frame  origin and axes
//   odom   the car's base at the first reading; drifts
//   base   the car: on the ground below the rear axle's middle, x forward, y left, z up
#pragma once

#include <deque>
#include <optional>

#include "robot/types/car.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin {

class Odometry {
 public:
  // car: with its calibration, if it has one.
  explicit Odometry(const CarDescription& car) : car_(car) {}
  // Readings in the order of their stamps.
  void Update(const DriveState& state);
  // T_odom_base, interpolated between two readings, and clamped to the oldest and newest kept (about a second apart).
  // Nothing before the first reading.
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

}  // namespace merlin
