#include "tools/drive/radio_hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace merlin {
namespace {

constexpr HandLimits kLimits{.speed_m_s = 0.7, .steering_rad = 0.35};
constexpr Duration kTick = std::chrono::milliseconds(50);

ManualCommand Ahead(Time now) {
  return {.heard = now, .held = true, .speed_m_s = 0.7, .steering_rad = -0.1, .autonomy = true};
}

TEST(RadioHand, TransmitsTheCommandInSevenths) {
  for (const int baud : {9600, 19200, 57600, 115200}) {
    RadioHand hand({.baud = baud}, kLimits, 1);
    ManualCommand heard;
    for (Time now{0}; now < 10 * kTick; now += kTick) heard = hand.Send(Ahead(now), now);
    EXPECT_TRUE(heard.held) << baud;
    EXPECT_TRUE(heard.autonomy);
    EXPECT_FALSE(heard.override_stop);
    EXPECT_NEAR(heard.speed_m_s, 0.7, 1e-12);
    EXPECT_NEAR(heard.steering_rad, -0.1, 1e-12);  // two sevenths of 0.35
    EXPECT_GE(heard.heard, 8 * kTick);
  }
}

TEST(RadioHand, IsAsLateAsTheRadio) {
  RadioHand hand({.baud = 9600}, kLimits, 1);
  const ManualCommand first = hand.Send(Ahead(Time(0)), Time(0));
  EXPECT_FALSE(first.held);
  EXPECT_LT(first.heard, Time(0));
  // 10 bytes: 10.4 ms on the cable, 1.6 ms of silence, 5 ms, 1.3 ms on air, 10.4 ms on the cable: 28.7 ms.
  ManualCommand wish = Ahead(Time(0));
  wish.heard = Time(-1);  // nothing more is sent
  Time now{0};
  while (!hand.Send(wish, now).held && now < kTick) now += std::chrono::microseconds(100);
  EXPECT_NEAR(Seconds(now), 0.0287, 0.002);
}

TEST(RadioHand, AgesWhenTheStationsStickHasGoneOrNothingIsHeard) {
  RadioHand hand({.baud = 57600}, kLimits, 1);
  Time now{0};
  for (; now < 10 * kTick; now += kTick) hand.Send(Ahead(now), now);
  ManualCommand gone = Ahead(now);  // of the last tick it was there
  Time last_heard{0};
  for (; now < 30 * kTick; now += kTick) last_heard = hand.Send(gone, now).heard;
  EXPECT_LE(last_heard, 12 * kTick);

  RadioHand deaf({.baud = 57600, .packet_loss = 1.0}, kLimits, 1);
  for (now = Time(0); now < 10 * kTick; now += kTick) EXPECT_LT(deaf.Send(Ahead(now), now).heard, Time(0));
}

TEST(RadioHand, NeverTransmitsANumberThatIsNotFinite) {
  RadioHand hand({.baud = 57600}, kLimits, 1);
  ManualCommand heard;
  for (Time now{0}; now < 10 * kTick; now += kTick) {
    ManualCommand wish = Ahead(now);
    wish.speed_m_s = std::nan("");
    heard = hand.Send(wish, now);
  }
  EXPECT_EQ(heard.speed_m_s, 0.0);
  EXPECT_EQ(heard.steering_rad, 0.0);
}

TEST(RadioHand, QuitsWithoutTheRadio) {
  RadioHand hand({.baud = 9600, .packet_loss = 1.0}, kLimits, 1);
  EXPECT_TRUE(hand.Send({.heard = Time(0), .quit = true}, Time(0)).quit);
}

}  // namespace
}  // namespace merlin
