// The on-board electronics of the drive: battery, H-bridge, microcontroller with its speed loop, encoder and steering
// servo. They turn a DriveCommand into a motor voltage and a steering set point, and report the drive's state.
#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>

#include "robot/types/car.h"
#include "robot/types/drivetrain_config.h"
#include "robot/types/measurements.h"
#include "sim/drive/battery.h"
#include "sim/drive/encoder.h"
#include "sim/drive/steering_servo.h"

namespace merlin::sim {

// The speed loop (feed-forward plus PI, with limited acceleration) runs at its own rate on encoder counts. It accounts
// for the steering linkage, so it controls the speed of the middle of the rear axle, not the mean speed of the four
// wheels. It uses the wheel radius and wheelbase of the description; where the true ones differ, the true speed
// differs.
class DriveController {
 public:
  DriveController() = default;
  DriveController(const mjModel* model, const CarDescription& car, const DrivetrainConfig& config, std::uint64_t seed);

  // Clamps the command to the car's limits. One that is not finite expires at once. See robot/hal/drive.h.
  void Send(const DriveCommand& command, Time now);
  // Writes data->ctrl for the coming step.
  void Apply(const mjModel* model, mjData* data, Time now);
  // Updates the encoder. Call once after every step.
  void Follow(const mjModel* model, const mjData* data);
  // The present state: encoder (whole counts of the motor shaft), steering, motor current and terminal voltage.
  DriveState Read(const mjModel* model, const mjData* data, Time now) const;

  const Battery& battery() const { return battery_; }

 private:
  void Regulate(const mjData* data, Time now, double period_s);
  double MeasuredSpeed_rad_s(const mjData* data, double period_s);
  MotorLoad LoadAt(const mjData* data) const;

  CarDescription car_;
  DrivetrainConfig config_;
  Battery battery_;
  Encoder encoder_;
  SteeringServo servo_;
  DriveCommand command_;
  Time expires_{0};  // no command is valid before the first one
  Time next_loop_{0};
  double shaft_inertia_kg_m2_ = 0.0;
  double speed_setpoint_m_s_ = 0.0;  // of the rear axle's middle, limited in acceleration
  double integral_v_ = 0.0;
  std::int64_t loop_counts_ = 0;  // encoder counts at the last cycle of the speed loop
  double still_s_ = 0.0;          // time since the last change of the counts
  double duty_ = 0.0;             // of the bridge
  double terminal_v_ = 0.0;       // of the battery, during the latest step
  int motor_ctrl_ = -1, motor_output_ = -1, servo_ctrl_ = -1, steering_qpos_ = -1;  // addresses in mjData
};

}  // namespace merlin::sim
