#include "tools/drive/stick.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

// 0 within the dead zone, and from its edge linearly to 1 at full travel.
double Travel(double axis) {
  const double beyond = (std::abs(axis) - Stick::kDeadZone) / (1.0 - Stick::kDeadZone);
  return beyond > 0.0 ? std::copysign(std::min(beyond, 1.0), axis) : 0.0;
}

}  // namespace

ManualCommand Stick::Update(const joystick::State& state, bool there, Time now) {
  if (!there) {
    wish_.held = wish_.override_stop = false;
    wish_.speed_m_s = wish_.steering_rad = 0.0;
    return wish_;
  }
  // The kernel's axes are positive to the right and backwards.
  const double left = -Travel(state.axes[kSteeringAxis]), ahead = -Travel(state.axes[kSpeedAxis]);
  wish_.heard = now;
  wish_.held = left != 0.0 || ahead != 0.0;
  wish_.speed_m_s = ahead * limits_.speed_m_s;
  wish_.steering_rad = left * limits_.steering_rad;
  wish_.override_stop = state.buttons[kOverrideButton];
  wish_.quit = wish_.quit || state.buttons[kQuitButton];
  const bool down = state.buttons[kAutonomyButton];
  if (down && !autonomy_was_down_) wish_.autonomy = !wish_.autonomy;
  autonomy_was_down_ = down;
  return wish_;
}

}  // namespace merlin
