#include "sim/drive/steering_servo.h"

#include <algorithm>
#include <cmath>

namespace merlin::sim {
namespace {

constexpr double kStraight_us = 1600.0, kFullLeft_us = 2000.0, kFullRight_us = 1000.0;

}  // namespace

double PulseOf_us(double steering_rad, double steering_max_rad) {
  const double end_us = steering_rad > 0.0 ? kFullLeft_us : kFullRight_us;
  return kStraight_us + (end_us - kStraight_us) * std::abs(steering_rad) / steering_max_rad;
}

double AngleOf_rad(double pulse_us, double steering_max_rad) {
  const double end_us = pulse_us > kStraight_us ? kFullLeft_us : kFullRight_us;
  return std::copysign(steering_max_rad * (pulse_us - kStraight_us) / (end_us - kStraight_us), pulse_us - kStraight_us);
}

SteeringServo::SteeringServo(const DrivetrainConfig& config, double steering_max_rad)
    : config_(config), steering_max_rad_(steering_max_rad) {}

double SteeringServo::LinkageTarget_rad(double command_rad, Time now) {
  if (config_.servo_period_s <= 0.0) {
    servo_rad_ = command_rad;
  } else if (now >= next_pulse_) {
    next_pulse_ += FromSeconds(config_.servo_period_s);
    const double pulse_us = PulseOf_us(command_rad, steering_max_rad_);
    if (std::abs(pulse_us - PulseOf_us(servo_rad_, steering_max_rad_)) > config_.servo_dead_band_us)
      servo_rad_ = AngleOf_rad(pulse_us, steering_max_rad_);
  }
  const double play_rad = 0.5 * config_.steering_backlash_rad;
  linkage_rad_ = std::clamp(linkage_rad_, servo_rad_ - play_rad, servo_rad_ + play_rad);
  return linkage_rad_ + config_.steering_offset_rad;
}

}  // namespace merlin::sim
