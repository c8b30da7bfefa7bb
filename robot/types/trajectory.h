// A path: poses with stamps, ascending. A run leaves no stamp twice; a file may have equal ones (tum_file.h).
#pragma once

#include <vector>

#include "robot/types/se3.h"
#include "robot/types/time.h"

namespace merlin {

struct StampedPose {
  Time stamp{0};
  Pose T = Pose::Identity();  // T_world_base of the truth, T_map_base of the estimate
};

using Trajectory = std::vector<StampedPose>;

}  // namespace merlin
