#include "sim/drive/drive_controller.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/limits.h"
#include "robot/kinematics/motion.h"
#include "sim/drive/drivetrain.h"

namespace merlin::sim {
namespace {

// Speed loop: closed-loop bandwidth and integral action, guesses that settle in 0.1 s without overshoot.
constexpr double kSpeedBandwidth_rad_s = 30.0;
constexpr double kSpeedIntegral_rad_s = 5.0;
// Deceleration after a command has expired. The contract in robot/hal/drive.h asks for 2 m/s2 after at most 0.2 s; the
// rest is margin.
constexpr double kBraking_m_s2 = 2.5;
// If the target speed is 0, the encoder has not moved for kStill_s and the integral is below kHold_v, the motor is
// shorted instead: the remaining integral would only move the car back and forth by one count. On a slope the integral
// is larger and keeps holding the car.
constexpr double kStill_s = 0.1, kHold_v = 0.3;

// Inertia of the whole car at the motor shaft: its mass at the wheel radius, the wheels and the rotor.
double ShaftInertia_kg_m2(const CarDescription& car) {
  double mass_kg = 0.0, wheels_kg_m2 = 0.0;
  for (const CarLink& link : car.links) mass_kg += link.mass_kg;
  for (const CarWheel& wheel : car.wheels) {
    const CarLink& link = car.links[wheel.link];
    const Eigen::Vector3d axis = link.T_link_inertial.linear().transpose() * link.axis;
    wheels_kg_m2 += axis.dot(link.inertia_kg_m2 * axis);
  }
  const double gear2 = car.drivetrain.gear * car.drivetrain.gear;
  return car.drivetrain.rotor_inertia_kg_m2 +
         (mass_kg * car.wheel_radius_m * car.wheel_radius_m + wheels_kg_m2) / gear2;
}

double Toward(double from, double to, double step) { return from + std::clamp(to - from, -step, step); }

}  // namespace

DriveController::DriveController(const mjModel* model, const CarDescription& car, const DrivetrainConfig& config,
                                 std::uint64_t seed)
    : car_(car),
      config_(config),
      battery_(config.battery, car.drivetrain.voltage_max_v),
      encoder_(config, car.drivetrain.encoder_counts_per_motor_turn, car.drivetrain.rotor_inertia_kg_m2, seed),
      servo_(config, car.steering_max_rad),
      shaft_inertia_kg_m2_(ShaftInertia_kg_m2(car)),
      terminal_v_(battery_.Terminal_v({})) {
  const int motor = mj_name2id(model, mjOBJ_ACTUATOR, drivetrain::kMotor);
  const int servo = mj_name2id(model, mjOBJ_ACTUATOR, drivetrain::kServo);
  if (motor < 0 || servo < 0) throw std::logic_error("the model has no drivetrain");
  motor_ctrl_ = model->actuator_ctrladr[motor];
  motor_output_ = model->actuator_outadr[motor];
  servo_ctrl_ = model->actuator_ctrladr[servo];
  steering_qpos_ = model->jnt_qposadr[model->actuator_trnid[2 * servo]];
}

void DriveController::Send(const DriveCommand& command, Time now) {
  if (!std::isfinite(command.speed_m_s) || !std::isfinite(command.steering_rad)) {
    expires_ = now;
    return;
  }
  command_ = ClampCommand(car_, command);
  expires_ = command.valid_for > Time::max() - now ? Time::max() : now + std::max(command.valid_for, Duration(0));
}

double DriveController::MeasuredSpeed_rad_s(const mjData* data, double period_s) {
  if (config_.speed_loop_s <= 0.0) return data->actuator_velocity[motor_output_];
  const std::int64_t counted = encoder_.counts() - loop_counts_;
  loop_counts_ = encoder_.counts();
  still_s_ = counted == 0 ? still_s_ + period_s : 0.0;
  return ShaftSpeed_rad_s(car_.drivetrain, counted, period_s);
}

// One cycle of the speed loop: sets the duty of the bridge until the next cycle.
void DriveController::Regulate(const mjData* data, Time now, double period_s) {
  const Drivetrain& d = car_.drivetrain;
  const bool expired = now >= expires_;
  const double acceleration_m_s2 = expired ? std::max(kBraking_m_s2, d.acceleration_max_m_s2) : d.acceleration_max_m_s2;
  const double before_m_s = speed_setpoint_m_s_;
  speed_setpoint_m_s_ = Toward(before_m_s, expired ? 0.0 : command_.speed_m_s, acceleration_m_s2 * period_s);

  // Convert the speed of the middle of the rear axle to that of the motor shaft, the mean of the four wheels.
  const double steering_rad = servo_.Report_rad(data->qpos[steering_qpos_]);
  const double shaft_rad_m = ShaftTurnPerMetre_rad_m(car_, steering_rad);
  const double target_rad_s = speed_setpoint_m_s_ * shaft_rad_m;
  const double error_rad_s = target_rad_s - MeasuredSpeed_rad_s(data, period_s);
  // V = K w + (R / K) torque. Feed-forward: back-EMF at the target speed plus the acceleration of the set point.
  // Feedback: PI on the error.
  const double volt_per_rad_s2 = d.resistance_ohm / d.motor_constant_v_s * shaft_inertia_kg_m2_;
  const double gain_v_s = volt_per_rad_s2 * kSpeedBandwidth_rad_s;
  const double feed_v = d.motor_constant_v_s * target_rad_s +
                        volt_per_rad_s2 * (speed_setpoint_m_s_ - before_m_s) / period_s * shaft_rad_m;
  const double unlimited_v = feed_v + gain_v_s * error_rad_s + integral_v_;
  const double limit_v = std::min(d.voltage_max_v, terminal_v_);
  double voltage_v = std::clamp(unlimited_v, -limit_v, limit_v);
  if (voltage_v == unlimited_v) integral_v_ += gain_v_s * kSpeedIntegral_rad_s * error_rad_s * period_s;  // no wind-up
  if (target_rad_s == 0.0 && still_s_ >= kStill_s && std::abs(integral_v_) < kHold_v) voltage_v = integral_v_ = 0.0;

  duty_ = voltage_v == 0.0 ? 0.0 : voltage_v / terminal_v_;
  if (config_.pwm_steps > 0.0) duty_ = std::round(duty_ * config_.pwm_steps) / config_.pwm_steps;
}

MotorLoad DriveController::LoadAt(const mjData* data) const {
  const Drivetrain& d = car_.drivetrain;
  // With an empty battery the bridge rests with both lower switches closed, so the motor is shorted and brakes.
  return {.duty = battery_.empty() ? 0.0 : duty_,
          .back_emf_v = d.motor_constant_v_s * data->actuator_velocity[motor_output_],
          .resistance_ohm = d.resistance_ohm};
}

void DriveController::Apply(const mjModel* model, mjData* data, Time now) {
  const double step_s = model->opt.timestep, loop_s = config_.speed_loop_s;
  if (now >= next_loop_) {
    Regulate(data, now, loop_s > 0.0 ? loop_s : step_s);
    next_loop_ += FromSeconds(loop_s > 0.0 ? loop_s : step_s);
  }
  const MotorLoad motor = LoadAt(data);
  terminal_v_ = battery_.Terminal_v(motor);
  battery_.Feed(motor, step_s);
  data->ctrl[motor_ctrl_] = motor.duty * terminal_v_;
  // After a command has expired, its steering angle is kept.
  data->ctrl[servo_ctrl_] = servo_.LinkageTarget_rad(command_.steering_rad, now);
}

void DriveController::Follow(const mjModel* model, const mjData* data) {
  const Drivetrain& d = car_.drivetrain;
  const double current_a = LoadAt(data).Current_a(terminal_v_);
  encoder_.Follow(data->actuator_length[motor_output_], d.motor_constant_v_s * current_a, model->opt.timestep);
}

DriveState DriveController::Read(const mjModel*, const mjData* data, Time now) const {
  DriveState state;
  state.stamp = now;
  state.encoder_counts = encoder_.counts();
  state.steering_rad = servo_.Report_rad(data->qpos[steering_qpos_]);
  state.current_a = LoadAt(data).Current_a(terminal_v_);
  state.battery_v = terminal_v_;
  state.expired = now >= expires_;
  return state;
}

}  // namespace merlin::sim
