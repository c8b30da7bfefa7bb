// Trajectories of the TUM RGB-D benchmark: "stamp_s x y z qx qy qz qw" a line, "#" starts a comment. (Written:
// writers.h.)
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "robot/types/trajectory.h"
#include "scenarios/judge/alignment.h"

namespace merlin {

struct TumFile {
  Trajectory trajectory{};
  std::vector<std::string> warnings{};  // quaternions off unit length, which are normalised; equal stamps
};

// Reads the whole text; name: the file's, for the errors. Throws InputError with every fault, each with name and line:
// a field that is missing, too much, no number or beyond 1e9, a quaternion of no length, a stamp that comes before the
// one above it; and for a text without poses.
TumFile ParseTum(std::string_view text, const std::string& name);

// Pairs as evo does: each pose of the trajectory that has fewer (of the estimate, where both have as many) with the
// other's nearest in time, the earlier of two as near, at most the difference away. Two poses may get the same partner.
// Of equal stamps the last serves poses at or after it, the first those before it.
std::vector<PosePair> PairAtNearestStamps(const Trajectory& truth, const Trajectory& estimate, Duration difference_max);

}  // namespace merlin
