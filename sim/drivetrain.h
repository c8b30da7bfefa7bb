// The car's motor and steering as the twin has them: MuJoCo's dcmotor on a differential tendon, a steering servo with
// slew, and the on-board controller that turns a DriveCommand into volts.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin::sim::drivetrain {

// Adds tendon, motor, steering servo and Ackermann equalities to a spec that holds the car's joints
// (names as in merlin.urdf; see sim/car_body.h).
void AddTo(mjSpec* spec, const CarDescription& car);

// The on-board controller: speed loop (PI, acceleration-limited), steering set point, expiry. Runs at every physics step.
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
  Time expires_{0};
  bool expired_ = true;
  double speed_setpoint_m_s_ = 0.0;
  double integral_v_ = 0.0;
  int motor_ = -1, servo_ctrl_ = -1, tendon_ = -1, steering_joint_ = -1;
};

}  // namespace merlin::sim::drivetrain
