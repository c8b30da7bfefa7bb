#include "robot/protocol/least_delay.h"

#include <gtest/gtest.h>

namespace merlin {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(LeastDelay, CountsFromTheQuickestMessage) {
  LeastDelay delay;  // the sender's clock shows 100 s less than ours
  EXPECT_EQ(delay.Lateness(0, seconds(100)), Duration(0));
  EXPECT_NEAR(Seconds(delay.Lateness(20, seconds(100) + milliseconds(70))), 0.050, 1e-4);
  EXPECT_EQ(delay.Lateness(40, seconds(100) + milliseconds(35)), Duration(0));  // quicker than the first: the new mark
  EXPECT_NEAR(Seconds(delay.Lateness(60, seconds(100) + milliseconds(60))), 0.005, 1e-4);
}

TEST(LeastDelay, FindsADuplicateAsLateAsItIs) {
  LeastDelay delay;
  delay.Lateness(1000, seconds(5));
  EXPECT_NEAR(Seconds(delay.Lateness(1000, seconds(5) + milliseconds(300))), 0.3, 1e-4);
}

TEST(LeastDelay, FollowsASlowClockWithoutCallingItLate) {
  LeastDelay delay;
  Duration worst{0};
  for (int i = 0; i < 36'000; ++i)  // an hour at 10 Hz, the sender's clock 100 ppm slow
    worst = std::max(worst, delay.Lateness(static_cast<std::uint32_t>(i * 100 * (1.0 - 1e-4)), milliseconds(100) * i));
  EXPECT_LT(worst, milliseconds(3));  // its rounding, and no growth
}

TEST(LeastDelay, GoesOnWhereTheSendersClockWraps) {
  LeastDelay delay;
  delay.Lateness(0xFFFFFFF0u, seconds(1));
  EXPECT_NEAR(Seconds(delay.Lateness(0x00000010u, seconds(1) + milliseconds(42))), 0.010, 1e-4);
}

TEST(LeastDelay, KnowsWhatIsOlderThanTheNewest) {
  LeastDelay delay;
  EXPECT_FALSE(delay.IsOld(5));
  delay.Lateness(1000, seconds(1));
  EXPECT_TRUE(delay.IsOld(999));
  EXPECT_FALSE(delay.IsOld(1000));
  EXPECT_FALSE(delay.IsOld(1001));
  delay.Reset();
  EXPECT_FALSE(delay.IsOld(999));
  EXPECT_EQ(delay.Lateness(0, seconds(50)), Duration(0));
}

}  // namespace
}  // namespace merlin
