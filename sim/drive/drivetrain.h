// The car's motor and steering in MuJoCo: a dcmotor actuator on a tendon that models the differentials, and a steering
// servo with a limited slew rate. Their set points come from sim/drive/drive_controller.h.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"

namespace merlin::sim::drivetrain {

// Names of the actuators. The servo acts on the joint of the virtual front wheel of the bicycle model.
inline constexpr char kMotor[] = "motor";
inline constexpr char kServo[] = "steering_servo";

// Adds tendon, motor, steering servo and Ackermann equalities to a spec that already has the car's joints (see
// sim/world/car_body.h). Motor and encoder turn at the mean speed of the four wheels. In a curve the encoder therefore
// counts more than the path of the middle of the rear axle (0.8 % at 10 deg of steering, 5.3 % at 25 deg).
void AddTo(mjSpec* spec, const CarDescription& car);

}  // namespace merlin::sim::drivetrain
