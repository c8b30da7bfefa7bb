#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>

#include "robot/base/error.h"
#include "scenarios/run/hear.h"
#include "scenarios/run/preflight.h"

namespace merlin {
namespace {

constexpr Duration kWindow = std::chrono::seconds(2);
constexpr Duration kListenPeriod = std::chrono::milliseconds(10);
constexpr double kRateShare = 0.3;
constexpr double kBatteryShareMin = 0.9, kBatteryShareMax = 1.3;
constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;
constexpr double kLevel_rad = 5.0 / kDegreesPerRad;
constexpr float kSameRange_m = 1e-4f;
constexpr int kSameGrey = 2;

// Everything received in the time window.
struct Heard {
  LoopState::Heard measurements;
  std::vector<SupervisedDevice> devices;
};

Heard Listen(const Robot& robot) {
  Heard heard;
  Ears ears(robot);
  ears.Hear(heard.measurements);
  heard.measurements = {};  // discard what arrived before the window
  for (const Time end = robot.clock->Now() + kWindow; robot.clock->Now() < end;) {
    if (!robot.clock->WaitUntil(robot.clock->Now() + kListenPeriod)) break;
    ears.Hear(heard.measurements);
  }
  heard.devices = ears.devices();
  return heard;
}

// The fault of a device that delivered count measurements in the window; empty if it delivers at its rate.
std::string RateFault(const SupervisedDevice& device, std::size_t count) {
  const double expected_hz = device.status.rate_hz, got_hz = static_cast<double>(count) / Seconds(kWindow);
  if (count == 0) return fmt::format("the {} delivers nothing", device.name);
  // The count may be off by one, depending on when the window begins.
  const double slack_hz = kRateShare * expected_hz + 1.0 / Seconds(kWindow);
  if (expected_hz <= 0.0 || std::abs(got_hz - expected_hz) <= slack_hz) return "";
  return fmt::format("the {} delivers {:.1f} measurements a second; expected {:.1f} +- {:.0f} %", device.name, got_hz,
                     expected_hz, 100.0 * kRateShare);
}

std::string DriveFault(const std::vector<DriveState>& states, const CarDescription& car) {
  double battery_v = 0.0;
  for (const DriveState& state : states) {
    if (!std::isfinite(state.steering_rad)) return "the drive reports a steering angle that is not a number";
    if (!std::isfinite(state.current_a)) return "the drive reports a motor current that is not a number";
    battery_v += state.battery_v / static_cast<double>(states.size());
  }
  const double nominal_v = car.drivetrain.voltage_max_v;
  const double least_v = kBatteryShareMin * nominal_v, most_v = kBatteryShareMax * nominal_v;
  if (battery_v >= least_v && battery_v <= most_v) return "";
  return fmt::format("the drive reports a battery of {:.1f} V; expected {:.1f} to {:.1f} V for a car of {:.1f} V",
                     battery_v, least_v, most_v, nominal_v);
}

std::string CompassFault(const std::vector<CompassReading>& readings) {
  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;
  for (const CompassReading& reading : readings) {
    const double share = 1.0 / static_cast<double>(readings.size());
    roll_rad += share * reading.roll_rad;
    pitch_rad += share * reading.pitch_rad;
    yaw_rad += share * reading.yaw_rad;
  }
  if (!std::isfinite(roll_rad + pitch_rad + yaw_rad)) return "the compass reads an angle that is not a number";
  if (std::abs(roll_rad) <= kLevel_rad && std::abs(pitch_rad) <= kLevel_rad) return "";

  return fmt::format("the compass reads roll {:.1f} deg, pitch {:.1f} deg; expected a car within {:.0f} deg of level",
                     kDegreesPerRad * roll_rad, kDegreesPerRad * pitch_rad, kDegreesPerRad * kLevel_rad);
}

// One good frame is enough.
std::string DepthFault(const std::vector<std::shared_ptr<const DepthFrame>>& frames) {
  std::optional<float> range_m;
  for (const auto& frame : frames) {
    float least_m = HUGE_VALF, most_m = -HUGE_VALF;
    for (std::size_t i = 0; i < frame->size(); ++i) {
      if ((frame->flags[i] & kInvalid) != 0 || !std::isfinite(frame->range_m[i])) continue;
      least_m = std::min(least_m, frame->range_m[i]);
      most_m = std::max(most_m, frame->range_m[i]);
    }
    if (most_m - least_m > kSameRange_m) return "";
    if (least_m <= most_m) range_m = least_m;
  }
  if (!range_m) return "the depth camera delivers frames without a single valid pixel: is something over its lens?";
  return fmt::format("the depth camera reads {:.3f} m in every pixel: it does not measure", *range_m);
}

std::string ColorFault(const std::vector<std::shared_ptr<const ColorFrame>>& frames) {
  for (const auto& frame : frames) {
    int spread = 0;  // largest difference of a channel from the first pixel
    for (std::size_t i = 3; i < frame->bgr.size(); ++i)
      spread = std::max(spread, std::abs(int{frame->bgr[i]} - int{frame->bgr[i % 3]}));
    if (spread > kSameGrey) return "";
  }
  return "the colour camera delivers pictures of one colour: is something over its lens?";
}

}  // namespace

std::vector<std::string> PreflightAtRest(const Robot& robot, const CarDescription& car) {
  Heard heard;
  try {
    heard = Listen(robot);
  } catch (const DeviceError& error) {
    return {error.what()};
  }
  std::vector<std::string> faults;
  const LoopState::Heard& m = heard.measurements;
  const auto check = [&](const std::string& name, std::size_t count, const auto& plausible) {
    const auto device = std::ranges::find(heard.devices, name, &SupervisedDevice::name);
    if (device == heard.devices.end()) return;
    faults.push_back(RateFault(*device, count));
    if (count > 0) faults.push_back(plausible());
  };
  const auto anything = [] { return std::string(); };
  check("drive", m.drive.size(), [&] { return DriveFault(m.drive, car); });
  check("compass", m.compass.size(), [&] { return CompassFault(m.compass); });
  check("depth camera", m.depth.size(), [&] { return DepthFault(m.depth); });
  check("colour camera", m.color.size(), [&] { return ColorFault(m.color); });
  check("pan unit", m.pan.size(), anything);
  check("turntable", m.turntable.size(), anything);
  std::erase(faults, "");
  return faults;
}

}  // namespace merlin
