#include "docs/examples/driver/text_compass.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace merlin {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::size_t kLongestLine = 80;  // whatever is longer is no line of this compass
constexpr int kLineBits = 10 * 30;        // of a usual line on the wire: it was measured before its first bit left

}  // namespace

TextCompassEnd::TextCompassEnd(const TextCompassConfig& config)
    : config_(config), health_(FromSeconds(config.silent_after_s)) {}

void TextCompassEnd::Receive(Time now, BytesView bytes) {
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n' || line_.size() == kLongestLine)
      TakeLine(now);
    else
      line_ += static_cast<char>(byte);
  }
  health_.GarbageSoFar(now, garbage_);
  health_.Judge(now);
}

void TextCompassEnd::TakeLine(Time now) {
  double heading_deg = 0.0, roll_deg = 0.0, pitch_deg = 0.0;
  const bool good = std::sscanf(line_.c_str(), "$ATT,%lf,%lf,%lf", &heading_deg, &roll_deg, &pitch_deg) == 3 &&
                    std::isfinite(heading_deg) && std::isfinite(roll_deg) && std::isfinite(pitch_deg);
  line_.clear();
  if (!good) {
    ++garbage_;
    return;
  }
  // A heading runs clockwise from north, a yaw counter-clockwise from x; nose up is a negative turn about y.
  const double yaw_rad = config_.north_yaw_rad - heading_deg * kRadPerDeg;
  readings.Put({.stamp = now - FromSeconds(double{kLineBits} / config_.serial.baud),
                .roll_rad = roll_deg * kRadPerDeg,
                .pitch_rad = -pitch_deg * kRadPerDeg,
                .yaw_rad = std::remainder(yaw_rad, 2.0 * std::numbers::pi)});
  health_.Heard(now);
}

}  // namespace merlin
