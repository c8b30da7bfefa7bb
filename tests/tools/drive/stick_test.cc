#include "tools/drive/stick.h"

#include <gtest/gtest.h>

#include <cmath>

namespace merlin {
namespace {

constexpr HandLimits kStickLimits{.speed_m_s = 0.8, .steering_rad = 0.4};
constexpr Time kStickTime = std::chrono::seconds(3);

joystick::State At(double right, double back) {
  joystick::State state;
  state.axes[0] = right;
  state.axes[1] = back;
  return state;
}

TEST(Stick, SteersLeftToTheLeftAndDrivesAheadToTheFront) {
  Stick stick(kStickLimits);
  ManualCommand wish = stick.Update(At(-1.0, -1.0), true, kStickTime);
  EXPECT_TRUE(wish.held);
  EXPECT_DOUBLE_EQ(wish.steering_rad, 0.4);
  EXPECT_DOUBLE_EQ(wish.speed_m_s, 0.8);
  EXPECT_EQ(wish.heard, kStickTime);
  wish = stick.Update(At(1.0, 1.0), true, kStickTime);
  EXPECT_DOUBLE_EQ(wish.steering_rad, -0.4);
  EXPECT_DOUBLE_EQ(wish.speed_m_s, -0.8);
}

TEST(Stick, IsLetGoInTheMiddleAndStartsFromZeroBeyondTheDeadZone) {
  Stick stick(kStickLimits);
  for (const double rest : {0.0, 0.11, -0.11}) {
    const ManualCommand wish = stick.Update(At(rest, rest), true, kStickTime);
    EXPECT_FALSE(wish.held) << rest;
    EXPECT_EQ(wish.speed_m_s, 0.0);
    EXPECT_EQ(wish.steering_rad, 0.0);
  }
  const ManualCommand wish = stick.Update(At(0.0, -0.13), true, kStickTime);
  EXPECT_TRUE(wish.held);
  EXPECT_NEAR(wish.speed_m_s, 0.8 * 0.01 / 0.88, 1e-12);
  EXPECT_NEAR(stick.Update(At(0.0, -0.56), true, kStickTime).speed_m_s, 0.4, 1e-12);  // half of what is left of the way
}

TEST(Stick, SwitchesAutonomyAtEachPressAndOverridesWhileHeld) {
  Stick stick(kStickLimits);
  joystick::State state;
  state.buttons[Stick::kAutonomyButton] = true;
  EXPECT_FALSE(stick.Update(state, true, kStickTime).autonomy) << "it was down before";
  state.buttons[Stick::kAutonomyButton] = false;
  stick.Update(state, true, kStickTime);
  state.buttons[Stick::kAutonomyButton] = true;
  EXPECT_TRUE(stick.Update(state, true, kStickTime).autonomy);
  EXPECT_TRUE(stick.Update(state, true, kStickTime).autonomy) << "still the same press";
  state.buttons[Stick::kAutonomyButton] = false;
  EXPECT_TRUE(stick.Update(state, true, kStickTime).autonomy);
  state.buttons[Stick::kAutonomyButton] = true;
  EXPECT_FALSE(stick.Update(state, true, kStickTime).autonomy);

  state.buttons[Stick::kOverrideButton] = true;
  EXPECT_TRUE(stick.Update(state, true, kStickTime).override_stop);
  state.buttons[Stick::kOverrideButton] = false;
  EXPECT_FALSE(stick.Update(state, true, kStickTime).override_stop);
  EXPECT_FALSE(stick.Update(state, true, kStickTime).quit);
  state.buttons[Stick::kQuitButton] = true;
  EXPECT_TRUE(stick.Update(state, true, kStickTime).quit);
}

TEST(Stick, LetsGoAndAgesWhenItHasGone) {
  Stick stick(kStickLimits);
  EXPECT_TRUE(stick.Update(At(0.0, -1.0), true, kStickTime).held);
  const ManualCommand wish = stick.Update(At(0.0, -1.0), false, kStickTime + std::chrono::seconds(1));
  EXPECT_FALSE(wish.held);
  EXPECT_EQ(wish.speed_m_s, 0.0);
  EXPECT_EQ(wish.heard, kStickTime);
}

TEST(Stick, NeverCommandsANumberThatIsNotFinite) {
  for (int i = -100; i <= 100; ++i) {
    const ManualCommand wish = Stick(kStickLimits).Update(At(i / 100.0, -i / 100.0), true, kStickTime);
    EXPECT_LE(std::abs(wish.speed_m_s), kStickLimits.speed_m_s);
    EXPECT_LE(std::abs(wish.steering_rad), kStickLimits.steering_rad);
  }
}

}  // namespace
}  // namespace merlin
