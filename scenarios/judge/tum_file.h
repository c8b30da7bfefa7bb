// Trajectories of the TUM RGB-D benchmark: "stamp_s x y z qx qy qz qw" a line, "#" starts a comment. (Written:
// writers.h.)
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/judge/alignment.h"
#include "scenarios/judge/trajectory.h"

namespace merlin {

struct TumFile {
  Trajectory trajectory{};
  std::vector<std::string> warnings{};  // quaternions off unit length, which are normalised
};

// Reads the whole text; name: the file's, for the errors. Throws InputError with name and line for a field that is
// missing, too much, no number or beyond 1e9, a quaternion of no length, a stamp that does not come after the one
// before it, and a text without poses.
TumFile ParseTum(std::string_view text, const std::string& name);

// Each pose of the one that has fewer (the estimate, of as many) with the other's nearest in time, the earlier of
// equals, at most the difference away: evo's rule. But one to one: a pose that two are nearest to goes to the nearer
// (the earlier of equals), where evo gives it to both.
std::vector<PosePair> PairAtNearestStamps(const Trajectory& truth, const Trajectory& estimate, Duration difference_max);

}  // namespace merlin
