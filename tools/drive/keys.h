// Turns the keys of a terminal into manual commands. A terminal does not report that a key is released, and repeats only the
// key that was pressed last. So any driving key keeps the car going, and the car stops when no key has come for a while.
//
//   w, arrow up      ahead, straight on         a, arrow left    a step of steering to the left
//   s, arrow down    back, straight on          d, arrow right   a step to the right
//   space            stops, autonomy too        p                autonomy on, off
//   q                ends the drive             W A S D, or Shift with an arrow: overrides the obstacle stop
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "autonomy/arbitrate.h"
#include "tools/drive/hand.h"

namespace merlin {

class Keys {
 public:
  static constexpr Duration kLetGo = std::chrono::milliseconds(700);  // longer than keyboards wait before they repeat
  static constexpr int kSteps = 5;                                    // of steering, from straight on to full

  explicit Keys(const HandLimits& limits) : limits_(limits) {}

  // The typed bytes, in pieces of any size. Unknown keys do nothing.
  void Feed(std::string_view typed, Time now);
  // The command now. It counts as heard now: a terminal is there even if nobody touches it.
  ManualCommand Wish(Time now) const;

 private:
  void Press(char key, bool shift, Time now);

  HandLimits limits_;
  std::string escape_;  // a sequence that has begun
  std::optional<Time> pressed_;
  int ahead_ = 0, left_ = 0;  // left_: steps
  bool override_stop_ = false, autonomy_ = false, quit_ = false;
};

}  // namespace merlin
