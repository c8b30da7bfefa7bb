// The steering geometry of a car: one steering angle to a curvature, to the angle of each front wheel and to the speed of
// the motor.
//
// The car follows the bicycle model: a virtual front wheel midway between the two real ones, and the middle of the rear
// axle, which is the origin of the base frame. When the virtual wheel is turned by the angle d, the origin moves on a
// circle of radius R = L / tan(d) about a point on the line of the rear axle (L: wheelbase). Ackermann's law says that
// every wheel rolls on a circle about that same point.
//
//        front left     virtual     front right      x (ahead)
//             |            |             |           ^
//             |            | L           |           |
//   C ------- rear left -- o -- rear right           o---> -y
//   |<----------- R ------>|
//
// Angles are positive to the left. `wheels_rad` is the angle of the virtual front wheel as it really stands; `servo_rad`
// is the angle that the steering servo is told and reports. A calibration finds the difference between the two.
// Source: R. Siegwart, I. Nourbakhsh, D. Scaramuzza, "Introduction to Autonomous Mobile Robots", 2nd edition, 2011,
// chapter 3 (mobile robot kinematics).
#pragma once

#include "robot/types/car.h"

namespace merlin {

// Between what the wheels do and what the servo says: wheels = servo + offset.
inline double WheelsAngle_rad(const CarDescription& car, double servo_rad) {
  return servo_rad + car.steering_offset_rad;
}
inline double ServoAngle_rad(const CarDescription& car, double wheels_rad) {
  return wheels_rad - car.steering_offset_rad;
}

// 1 / R of the circle that the origin of the base frame moves on, positive to the left.
double Curvature_1_m(const CarDescription& car, double wheels_rad);

// The inverse: the angle that the virtual front wheel needs, in (-pi/2, pi/2). It knows no limit; see limits.h.
double WheelsAngleForCurvature_rad(const CarDescription& car, double curvature_1_m);

enum class Side { kLeft, kRight };

// The angle of one front wheel. The inner wheel turns more than the virtual one, the outer wheel less.
double FrontWheelAngle_rad(const CarDescription& car, double wheels_rad, Side side);

// How much farther the four wheels roll, on average, than the origin of the base frame moves. The encoder sits behind
// ideal differentials and counts the former. 1 straight ahead; 1.053 at 25 degrees for a wheelbase of 0.33 m and a track
// of 0.26 m; the same to both sides.
double WheelMeanRatio(const CarDescription& car, double wheels_rad);

// How far the motor shaft turns while the origin of the base frame moves a metre.
double ShaftTurnPerMetre_rad_m(const CarDescription& car, double wheels_rad);

}  // namespace merlin
