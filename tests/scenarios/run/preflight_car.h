// A car of simple arithmetic for the pre-flight check. It reaches the commanded speed and steering at once, its devices
// deliver at their rates, and each can be made to report something wrong.
#pragma once

#include <cmath>
#include <optional>
#include <stdexcept>

#include "robot/hal/hal.h"
#include "robot/types/car.h"

namespace merlin {

// A device that delivers a given number of measurements a second, and can be switched off.
class Rate {
 public:
  explicit Rate(double hz) : told_hz(hz), true_hz(hz) {}
  // The stamp of the next measurement, if it is due.
  std::optional<Time> Next(Time now) {
    if (true_hz <= 0.0) return std::nullopt;
    const Time stamp = last_ + FromSeconds(1.0 / true_hz);
    if (stamp > now) return std::nullopt;
    return last_ = stamp;
  }
  DeviceStatus Status() const { return {.rate_hz = told_hz}; }

  double told_hz, true_hz;

 private:
  Time last_{0};
};

class PreflightCar {
 public:
  static constexpr double kWheelbase_m = 0.33, kMetresPerCount = 1e-3;

  PreflightCar() {
    color_info.sheet.camera.width = color_info.sheet.camera.height = 8;
    description.wheelbase_m = kWheelbase_m;
    description.track_m = 0.26;
    description.steering_max_rad = 0.43;
    description.wheel_radius_m = 0.05;
    description.drivetrain.voltage_max_v = 12.0;
    description.drivetrain.gear = 1.0;
    // One count is a millimetre.
    description.drivetrain.encoder_counts_per_motor_turn = 1000;
    description.wheel_radius_m = 1000 * kMetresPerCount / (2.0 * M_PI);
  }

  Robot robot() {
    return {.clock = &clock_, .depth = &depth_, .color = &color_, .compass = &compass_, .drive = &drive_};
  }

  CarDescription description;
  ColorCameraInfo color_info;
  Rate drive{50.0}, compass{12.5}, depth{20.0}, color{10.0};
  double battery_v = 12.5, roll_rad = 0.01, pitch_rad = -0.01;
  double servo_reports_rad = NAN;  // instead of what was commanded
  double compass_turns = 1.0;      // turn by the compass over true turn
  double wheels_turn = 1.0;        // motion over command
  bool ignores_expiry = false;     // drives on when commands stop
  bool drive_throws = false;
  bool same_range = false, no_range = false, one_color = false;
  double fastest_m_s = 0.0;

  double speed_m_s() const { return ignores_expiry || clock_.now < expires_ ? wheels_turn * command_.speed_m_s : 0.0; }
  double x_m() const { return x_m_; }
  double yaw_rad() const { return yaw_rad_; }

 private:
  void Step(Duration step) {
    const double path_m = speed_m_s() * Seconds(step);
    fastest_m_s = std::max(fastest_m_s, std::abs(speed_m_s()));
    yaw_rad_ += path_m * std::tan(command_.steering_rad) / kWheelbase_m;
    x_m_ += path_m * std::cos(yaw_rad_);
    path_m_ += path_m;
  }

  struct : Clock {
    Time Now() const override { return now; }
    bool WaitUntil(Time time) override {
      while (now < time) now += std::chrono::milliseconds(1), car->Step(std::chrono::milliseconds(1));
      return true;
    }
    Time now{0};
    PreflightCar* car = nullptr;
  } clock_;

  struct : Drive {
    void Send(const DriveCommand& command) override {
      car->command_ = command;
      car->expires_ = car->clock_.now + command.valid_for;
    }
    std::optional<DriveState> Poll() override {
      if (car->drive_throws) throw std::runtime_error("the cable is cut");
      const auto stamp = car->drive.Next(car->clock_.now);
      if (!stamp) return std::nullopt;
      const double servo_rad = std::isnan(car->servo_reports_rad) ? car->command_.steering_rad : car->servo_reports_rad;
      return DriveState{.stamp = *stamp,
                        .encoder_counts = std::llround(car->path_m_ / kMetresPerCount),
                        .steering_rad = servo_rad,
                        .battery_v = car->battery_v};
    }
    DeviceStatus Status() const override { return car->drive.Status(); }
    PreflightCar* car = nullptr;
  } drive_;

  struct : Compass {
    std::optional<CompassReading> Poll() override {
      const auto stamp = car->compass.Next(car->clock_.now);
      if (!stamp) return std::nullopt;
      return CompassReading{.stamp = *stamp,
                            .roll_rad = car->roll_rad,
                            .pitch_rad = car->pitch_rad,
                            .yaw_rad = std::remainder(3.0 + car->compass_turns * car->yaw_rad_, 2.0 * M_PI)};
    }
    DeviceStatus Status() const override { return car->compass.Status(); }
    PreflightCar* car = nullptr;
  } compass_;

  struct : DepthCamera {
    const DepthCameraInfo& Info() const override { return info; }
    void Configure(const DepthSettings&) override {}
    std::optional<DepthFrame> Poll() override {
      const auto stamp = car->depth.Next(car->clock_.now);
      if (!stamp) return std::nullopt;
      DepthFrame frame;
      frame.stamp = *stamp, frame.width = 4, frame.height = 2;
      for (int i = 0; i < 8; ++i)
        frame.range_m.push_back(car->same_range ? 1.234f : 1.0f + 0.1f * static_cast<float>(i));
      frame.flags.assign(8, car->no_range ? kInvalid : 0);
      return frame;
    }
    DeviceStatus Status() const override { return car->depth.Status(); }
    DepthCameraInfo info;
    PreflightCar* car = nullptr;
  } depth_;

  struct : ColorCamera {
    const ColorCameraInfo& Info() const override { return car->color_info; }
    void Configure(const ColorSettings&) override {}
    std::optional<ColorFrame> Poll() override {
      const auto stamp = car->color.Next(car->clock_.now);
      if (!stamp) return std::nullopt;
      ColorFrame frame;
      frame.stamp = *stamp, frame.width = frame.height = 8;
      for (int i = 0; i < 64; ++i)  // a single colour, but not grey
        for (const int channel : {10, 90, 200})
          frame.bgr.push_back(static_cast<std::uint8_t>(channel + (car->one_color ? i % 2 : i / 2)));
      return frame;
    }
    DeviceStatus Status() const override { return car->color.Status(); }
    PreflightCar* car = nullptr;
  } color_;

  DriveCommand command_;
  Time expires_{0};
  double path_m_ = 0.0, x_m_ = 0.0, yaw_rad_ = 0.0;

 public:
  // The devices know their car.
  PreflightCar* Wired() {
    clock_.car = drive_.car = compass_.car = depth_.car = color_.car = this;
    return this;
  }
};

}  // namespace merlin
