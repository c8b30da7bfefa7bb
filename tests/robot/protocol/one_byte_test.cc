#include "robot/protocol/one_byte.h"

#include <gtest/gtest.h>

#include <limits>

namespace merlin {
namespace {

constexpr OneByteLimits kLimits{.speed_m_s = 1.4, .steering_rad = 0.35};
constexpr Duration kHolds = std::chrono::milliseconds(200);

std::uint8_t Encode(double speed_m_s, double steering_rad) {
  return EncodeOneByte({.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = kHolds}, kLimits);
}

TEST(OneByte, IsSpeedAndSteeringInSeventhsOfTheLimit) {
  EXPECT_EQ(Encode(0.0, 0.0), 0x00);
  EXPECT_EQ(Encode(1.4, 0.35), 0x77);
  EXPECT_EQ(Encode(-1.4, -0.35), 0x99);
  EXPECT_EQ(Encode(0.2, -0.05), 0x1F);
  EXPECT_EQ(Encode(0.29, 0.0), 0x10);    // the nearest step
  EXPECT_EQ(Encode(1e30, -1e30), 0x79);  // clamped
}

TEST(OneByte, ComesBackForEveryNumberOfTheCode) {
  for (int speed = -7; speed <= 7; ++speed)
    for (int steering = -7; steering <= 7; ++steering) {
      const auto byte = static_cast<std::uint8_t>((speed & 15) << 4 | (steering & 15));
      const DriveCommand command = DecodeOneByte(byte, kLimits, kHolds);
      EXPECT_NEAR(command.speed_m_s, 0.2 * speed, 1e-12);
      EXPECT_NEAR(command.steering_rad, 0.05 * steering, 1e-12);
      EXPECT_EQ(command.valid_for, kHolds);
      EXPECT_EQ(EncodeOneByte(command, kLimits), byte);
    }
}

TEST(OneByte, StopsForWhatIsNoCommand) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_EQ(Encode(bad, 0.1), 0x00);
    EXPECT_EQ(Encode(0.5, bad), 0x00);
  }
  EXPECT_EQ(EncodeOneByte({.speed_m_s = 1.0, .valid_for = Duration(0)}, kLimits), 0x00);
  for (const std::uint8_t byte : {0x80, 0x08, 0x87, 0x78})
    EXPECT_EQ(DecodeOneByte(byte, kLimits, kHolds).speed_m_s, 0.0);
}

}  // namespace
}  // namespace merlin
