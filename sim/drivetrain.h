// The car's motor and steering as the twin has them: MuJoCo's dcmotor on a differential tendon, a steering servo with
// slew, and the on-board controller that turns a DriveCommand into volts.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin::sim::drivetrain {

// Adds tendon, motor, steering servo and Ackermann equalities to a spec that holds the car's joints (see
// sim/car_body.h). The motor turns with the mean of the four wheels: so does the encoder, which in a turn counts more
// than the path of the rear axle's middle (0.8 % at 10 deg of steering, 5.3 % at 25 deg).
void AddTo(mjSpec* spec, const CarDescription& car);

// The on-board controller: speed loop (feed-forward and PI, acceleration-limited), steering set point, expiry. Runs at
// every physics step. It knows the linkage and regulates the speed of the rear axle's middle, not the four wheels'
// mean.
class Controller {
 public:
  Controller() = default;
  Controller(const mjModel* model, const CarDescription& car);

  // Clamped to the car's limits; not finite: expires at once. See robot/hal/drive.h.
  void Send(const DriveCommand& command, Time now);
  // Writes data->ctrl for the coming step.
  void Apply(const mjModel* model, mjData* data, Time now);
  // Encoder (whole counts of the motor shaft), steering, current, battery, as they stand now.
  DriveState Read(const mjModel* model, const mjData* data, Time now) const;

 private:
  CarDescription car_;
  DriveCommand command_;
  Time expires_{0};  // nothing holds before the first command
  double shaft_inertia_kg_m2_ = 0.0;
  double speed_setpoint_m_s_ = 0.0;  // of the rear axle's middle, limited in acceleration
  double integral_v_ = 0.0;
  int motor_ctrl_ = -1, motor_output_ = -1, servo_ctrl_ = -1, steering_qpos_ = -1;  // addresses in mjData
};

}  // namespace merlin::sim::drivetrain
