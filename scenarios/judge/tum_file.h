// Reads trajectories in the format of the TUM RGB-D benchmark: one line "stamp_s x y z qx qy qz qw" per pose; "#"
// starts a comment. writers.h writes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "robot/types/trajectory.h"
#include "scenarios/judge/alignment.h"

namespace merlin {

struct TumFile {
  Trajectory trajectory{};
  std::vector<std::string> warnings{};  // for quaternions not of unit length (they are normalised) and equal stamps
};

// Parses the text of a file. name: of the file, for messages. Throws InputError with all faults, each with name and
// line: a field that is missing, extra, not a number or beyond 1e9, a quaternion of length 0, a stamp before that of
// the line above; or if there are no poses.
TumFile ParseTum(std::string_view text, const std::string& name);

// Pairs like evo: each pose of the shorter trajectory (the estimate if both have the same length) gets the pose of the
// other that is nearest in time, at most difference_max away; of two equally near ones the earlier. Two poses may get
// the same partner. Of several poses with equal stamps, the last is used for poses at or after that stamp, the first
// for poses before it.
std::vector<PosePair> PairAtNearestStamps(const Trajectory& truth, const Trajectory& estimate, Duration difference_max);

}  // namespace merlin
