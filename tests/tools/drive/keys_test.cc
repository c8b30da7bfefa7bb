#include "tools/drive/keys.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace merlin {
namespace {

constexpr HandLimits kLimits{.speed_m_s = 0.8, .steering_rad = 0.4};
constexpr Time kNow = std::chrono::seconds(3);
constexpr Duration kStep = std::chrono::milliseconds(100);

ManualCommand After(const std::string& typed) {
  Keys keys(kLimits);
  keys.Feed(typed, kNow);
  return keys.Wish(kNow);
}

TEST(Keys, DriveAheadBackLeftAndRight) {
  EXPECT_FALSE(After("").held);
  for (const char* ahead : {"w", "\x1b[A", "\x1bOA"}) EXPECT_DOUBLE_EQ(After(ahead).speed_m_s, 0.8) << ahead + 1;
  for (const char* back : {"s", "\x1b[B"}) EXPECT_DOUBLE_EQ(After(back).speed_m_s, -0.8);
  for (const char* left : {"a", "\x1b[D"}) EXPECT_NEAR(After(left).steering_rad, 0.4 / 5, 1e-12);
  for (const char* right : {"d", "\x1b[C"}) EXPECT_NEAR(After(right).steering_rad, -0.4 / 5, 1e-12);
  EXPECT_DOUBLE_EQ(After("a").speed_m_s, 0.0);
  EXPECT_TRUE(After("a").held);
}

TEST(Keys, SteerInStepsUpToTheLimitWhileDrivingOn) {
  const ManualCommand wish = After("waaaaaaaaaaaa");
  EXPECT_DOUBLE_EQ(wish.steering_rad, 0.4);
  EXPECT_DOUBLE_EQ(wish.speed_m_s, 0.8);
  EXPECT_DOUBLE_EQ(After("waaw").steering_rad, 0.0);  // straight on again
  EXPECT_NEAR(After("waad").steering_rad, 0.08, 1e-12);
}

TEST(Keys, LetGoWhenNoneIsTypedForAWhile) {
  Keys keys(kLimits);
  keys.Feed("w", kNow);
  keys.Feed("a", kNow + 6 * kStep);
  EXPECT_TRUE(keys.Wish(kNow + 12 * kStep).held);
  const ManualCommand wish = keys.Wish(kNow + 6 * kStep + Keys::kLetGo);
  EXPECT_FALSE(wish.held);
  EXPECT_EQ(wish.speed_m_s, 0.0);
  EXPECT_EQ(wish.steering_rad, 0.0);
  EXPECT_EQ(wish.heard, kNow + 6 * kStep + Keys::kLetGo);
  keys.Feed("a", kNow + 20 * kStep);  // begins anew: the old speed does not come back
  EXPECT_EQ(keys.Wish(kNow + 20 * kStep).speed_m_s, 0.0);
}

TEST(Keys, StopAtOnceForSpaceAutonomyToo) {
  const ManualCommand wish = After("pw ");
  EXPECT_FALSE(wish.held);
  EXPECT_FALSE(wish.autonomy);
  EXPECT_TRUE(After("p").autonomy);
  EXPECT_FALSE(After("pp").autonomy);
  EXPECT_TRUE(After("q").quit);
}

TEST(Keys, OverrideWithShiftForAsLongAsItIsHeld) {
  EXPECT_TRUE(After("W").override_stop);
  EXPECT_DOUBLE_EQ(After("W").speed_m_s, 0.8);
  EXPECT_TRUE(After("\x1b[1;2A").override_stop);
  EXPECT_DOUBLE_EQ(After("\x1b[1;2A").speed_m_s, 0.8);
  EXPECT_FALSE(After("Ww").override_stop);
  EXPECT_FALSE(After("\x1b[1;5A").override_stop);  // Ctrl
}

TEST(Keys, UnderstandSequencesInPieces) {
  Keys keys(kLimits);
  for (const char* piece : {"\x1b", "[", "1", ";2", "D"}) keys.Feed(piece, kNow);
  EXPECT_NEAR(keys.Wish(kNow).steering_rad, 0.08, 1e-12);
}

TEST(Keys, StayWithinTheLimitsWhateverIsTyped) {
  std::mt19937 random(1);
  Keys keys(kLimits);
  for (int i = 0; i < 100000; ++i) {
    const char c = static_cast<char>(random());
    keys.Feed(std::string_view(&c, 1), kNow + i * kStep / 10);
    const ManualCommand wish = keys.Wish(kNow + i * kStep / 10);
    ASSERT_LE(std::abs(wish.speed_m_s), kLimits.speed_m_s);
    ASSERT_LE(std::abs(wish.steering_rad), kLimits.steering_rad + 1e-12);
  }
  keys.Feed("~w", kNow + 100000 * kStep);  // a broken sequence ends
  EXPECT_DOUBLE_EQ(keys.Wish(kNow + 100000 * kStep).speed_m_s, 0.8);
}

}  // namespace
}  // namespace merlin
