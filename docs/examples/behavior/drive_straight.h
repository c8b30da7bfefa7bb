// Drives straight ahead for a length, then stops for good.
#pragma once

#include <optional>

#include "autonomy/intent.h"
#include "autonomy/situation.h"

namespace merlin {

struct DriveStraightConfig {
  double length_m = 2.0;   // [0, 100]
  double speed_m_s = 0.3;  // [0.05, 2]
};

class DriveStraight {
 public:
  explicit DriveStraight(const DriveStraightConfig& config) : config_(config) {}
  Intent Decide(const Situation& situation);

 private:
  DriveStraightConfig config_;
  std::optional<Pose> T_map_start_;  // of the base when it was first asked
};

}  // namespace merlin
