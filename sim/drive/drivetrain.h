// The car's motor and steering in MuJoCo: MuJoCo's dcmotor on a differential tendon, and a steering servo with
// slew. sim/drive/drive_controller.h gives them their set points.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"

namespace merlin::sim::drivetrain {

// The actuators' names. The servo's transmission is the joint of the virtual middle front wheel.
inline constexpr char kMotor[] = "motor";
inline constexpr char kServo[] = "steering_servo";

// Adds tendon, motor, steering servo and Ackermann equalities to a spec that holds the car's joints (see
// sim/world/car_body.h). The motor turns with the mean of the four wheels: so does the encoder, which in a turn counts more
// than the path of the rear axle's middle (0.8 % at 10 deg of steering, 5.3 % at 25 deg).
void AddTo(mjSpec* spec, const CarDescription& car);

}  // namespace merlin::sim::drivetrain
