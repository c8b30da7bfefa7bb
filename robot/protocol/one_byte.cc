#include "robot/protocol/one_byte.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr int kSteps = 7, kNoNumber = -8;

unsigned Nibble(double value, double limit) {
  return static_cast<unsigned>(std::lround(std::clamp(value / limit, -1.0, 1.0) * kSteps)) & 0xFu;
}

int Signed(unsigned nibble) { return static_cast<int>(nibble ^ 8u) - 8; }

}  // namespace

std::uint8_t EncodeOneByte(const DriveCommand& command, const OneByteLimits& limits) {
  if (!std::isfinite(command.speed_m_s) || !std::isfinite(command.steering_rad)) return 0;
  if (command.valid_for <= Duration(0)) return 0;
  return static_cast<std::uint8_t>(Nibble(command.speed_m_s, limits.speed_m_s) << 4 |
                                   Nibble(command.steering_rad, limits.steering_rad));
}

DriveCommand DecodeOneByte(std::uint8_t byte, const OneByteLimits& limits, Duration valid_for) {
  const int speed = Signed(byte >> 4), steering = Signed(byte & 0xFu);
  if (speed == kNoNumber || steering == kNoNumber) return {.valid_for = valid_for};
  return {.speed_m_s = speed * limits.speed_m_s / kSteps,
          .steering_rad = steering * limits.steering_rad / kSteps,
          .valid_for = valid_for};
}

}  // namespace merlin
