// The least a car can be: it has the commanded speed at once, and none once the command has expired.
#pragma once

#include <cmath>

#include "robot/emulated/microcontroller_emulator.h"

namespace merlin {

class ToyCar {
 public:
  static constexpr double kCountsPerMetre = 1000.0;

  void Step(Time now) {
    metres_ += Speed_m_s() * Seconds(now - now_);
    now_ = now;
  }
  void Send(const DriveCommand& command) {
    command_ = command;
    expires_ = now_ + command.valid_for;
  }
  bool braked() const { return now_ >= expires_; }
  double Speed_m_s() const { return braked() ? 0.0 : command_.speed_m_s; }
  DriveState Read() const {
    return {.stamp = now_,
            .encoder_counts = counts_at_start + std::llround(kCountsPerMetre * metres_),
            .steering_rad = command_.steering_rad,
            .current_a = 1.5,
            .battery_v = battery_v,
            .expired = braked()};
  }
  EmulatedCar Wired() {
    return {.send = [this](const DriveCommand& command) { Send(command); },
            .read = [this] { return Read(); },
            .pan = [this](double angle_rad) { pan_rad = angle_rad; },
            .pan_angle_rad = [this] { return pan_rad; }};
  }

  std::int64_t counts_at_start = 0;
  double pan_rad = 0.0;
  double battery_v = 12.0;

 private:
  Time now_{0}, expires_{0};
  DriveCommand command_;
  double metres_ = 0.0;
};

}  // namespace merlin
