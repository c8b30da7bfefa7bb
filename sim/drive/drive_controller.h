// The on-board electronics of the drive: battery, H-bridge, microcontroller with its speed loop, encoder and servo. They
// turn a DriveCommand into a motor voltage and a steering set point, and report the drive's state.
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

// The speed loop (feed-forward and PI, limited in acceleration) runs at its own rate from encoder counts. It knows the
// linkage and regulates the speed of the rear axle's middle, not the four wheels' mean. It believes the description: a car
// of another wheel radius or wheelbase drives another speed.
class DriveController {
 public:
  DriveController() = default;
  DriveController(const mjModel* model, const CarDescription& car, const DrivetrainConfig& config, std::uint64_t seed);

  // Clamped to the car's limits; not finite: expires at once. See robot/hal/drive.h.
  void Send(const DriveCommand& command, Time now);
  // Writes data->ctrl for the coming step.
  void Apply(const mjModel* model, mjData* data, Time now);
  // Once after every step, of which data is the end: the encoder counts.
  void Follow(const mjModel* model, const mjData* data);
  // Encoder (whole counts of the motor shaft), steering, the motor's current, the battery's terminal voltage, all
  // of this instant.
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
  Time expires_{0};  // nothing holds before the first command
  Time next_loop_{0};
  double shaft_inertia_kg_m2_ = 0.0;
  double speed_setpoint_m_s_ = 0.0;  // of the rear axle's middle, limited in acceleration
  double integral_v_ = 0.0;
  std::int64_t loop_counts_ = 0;  // the encoder's at the last turn of the loop
  double still_s_ = 0.0;          // how long it has counted nothing
  double duty_ = 0.0;             // of the bridge
  double terminal_v_ = 0.0;       // of the battery, during the coming or last step
  int motor_ctrl_ = -1, motor_output_ = -1, servo_ctrl_ = -1, steering_qpos_ = -1;  // addresses in mjData
};

}  // namespace merlin::sim
