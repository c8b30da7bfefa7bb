#include "tools/drive/keys.h"

#include <algorithm>
#include <cctype>

namespace merlin {
namespace {

constexpr char kEscape = '\x1b';

// The letter that has the same meaning as an arrow key.
char Letter(char arrow) {
  switch (arrow) {
    case 'A':
      return 'w';
    case 'B':
      return 's';
    case 'C':
      return 'd';
    case 'D':
      return 'a';
    default:
      return '\0';
  }
}

bool IsFinal(char c) { return c >= '@' && c <= '~'; }

}  // namespace

void Keys::Feed(std::string_view typed, Time now) {
  for (const char c : typed) {
    if (c == kEscape) {
      escape_ = c;
    } else if (escape_.empty()) {
      const auto byte = static_cast<unsigned char>(c);
      Press(static_cast<char>(std::tolower(byte)), std::isupper(byte) != 0, now);
    } else if (escape_.size() ==
               1) {  // ESC [ and ESC O begin a key; after ESC and any other, that was Escape, then Alt
      if (c == '[' || c == 'O')
        escape_ += c;
      else
        escape_.clear();
    } else if (IsFinal(c)) {
      Press(Letter(c), escape_.find(";2") != std::string::npos, now);
      escape_.clear();
    } else if (escape_.size() < 8) {
      escape_ += c;
    } else {
      escape_.clear();
    }
  }
}

void Keys::Press(char key, bool shift, Time now) {
  if (key == 'q') quit_ = true;
  if (key == 'p') autonomy_ = !autonomy_;
  if (key == ' ') pressed_.reset(), autonomy_ = false;
  if (std::string_view("wasd").find(key) == std::string_view::npos || key == '\0') return;
  if (!Wish(now).held) ahead_ = left_ = 0;
  pressed_ = now;
  override_stop_ = shift;
  if (key == 'w' || key == 's') ahead_ = key == 'w' ? 1 : -1, left_ = 0;
  if (key == 'a' || key == 'd') left_ = std::clamp(left_ + (key == 'a' ? 1 : -1), -kSteps, kSteps);
}

ManualCommand Keys::Wish(Time now) const {
  ManualCommand wish{.heard = now, .autonomy = autonomy_, .quit = quit_};
  wish.held = pressed_ && now - *pressed_ < kLetGo;
  if (!wish.held) return wish;
  wish.speed_m_s = ahead_ * limits_.speed_m_s;
  wish.steering_rad = left_ * limits_.steering_rad / kSteps;
  wish.override_stop = override_stop_;
  return wish;
}

}  // namespace merlin
