// From encoder counts and a steering angle to the motion of the car, and the arc that lies ahead of it.
//
// A path is the signed length that the origin of the base frame (middle of the rear axle) moves, negative backwards.
// While the steering angle stays, the car moves on a circle; `ArcMotion` is exact on it, not a small step.
// Source: the car model (equations 3.1 to 3.5, here with a signed speed) of the thesis
// "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination", University of Siegen, about 2011.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "robot/types/car.h"
#include "robot/types/se3.h"

namespace merlin {

// The path for so many encoder counts at a steering angle of the wheels.
double Path_m(const CarDescription& car, std::int64_t encoder_counts, double wheels_rad);

// The speed of the motor shaft that turned by so many encoder counts within a time. A drivetrain without an encoder
// (0 counts a turn) is taken to have one count a turn.
double ShaftSpeed_rad_s(const Drivetrain& drivetrain, std::int64_t encoder_counts, double period_s);

// By how much the car turns along a path, positive to the left.
double Turn_rad(const CarDescription& car, double path_m, double wheels_rad);

// Where an arc of length 1 that turns by an angle ends: ahead and to the left. Smooth through 0, where the arc is a straight
// line.
struct ArcShape {
  double along, across;
};
ArcShape ShapeOfArc(double turn_rad);

// The motion along a path that turns the car by an angle: T_before_after.
Pose ArcMotion(double path_m, double turn_rad);

// The positions (base frame) that the origin of the base frame will pass through while the wheels keep their angle: every
// 5 cm from the present one on, up to a length; a negative length is driven backwards. The angle is clamped to what the
// car can steer.
std::vector<Eigen::Vector2d> ArcAhead(const CarDescription& car, double wheels_rad, double length_m);

}  // namespace merlin
