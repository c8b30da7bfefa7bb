// The car stands on a turntable, which turns it through an angle: to map a room from one place. The car itself stands
// still; the turntable is sent to its angle, and the behaviour is done when it has arrived.
#pragma once

#include <optional>

#include "autonomy/intent.h"
#include "autonomy/situation.h"

namespace merlin {

struct TurnOnTurntableConfig {
  double angle_rad = 0.0;  // from the start, positive to the left; may be more than a full turn
};

class TurnOnTurntable {
 public:
  explicit TurnOnTurntable(const TurnOnTurntableConfig& config) : config_(config) {}
  Intent Decide(const Situation& situation);

 private:
  TurnOnTurntableConfig config_;
  std::optional<double> last_yaw_rad_;  // of the odometry at the last frame
  double turned_rad_ = 0.0;             // since the first frame, not wrapped
};

}  // namespace merlin
