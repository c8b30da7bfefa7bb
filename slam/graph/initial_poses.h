// Initial poses for a graph whose own are unknown or bad.
#pragma once

#include <optional>
#include <vector>

#include "slam/graph/pose_graph.h"

namespace merlin {

// Chains the edges, starting at the fixed poses, along the spanning tree whose edges join the nearest indices: that is
// the chain of odometry where there is one. Poses that no edge reaches stay.
std::vector<Pose> ChainedPoses(const PoseGraph& graph);

// Chordal initialisation (L. Carlone et al., "Initialization techniques for 3D SLAM", ICRA 2015). First the matrices
// that minimise the rotational part of objective A, and the rotations nearest to them; then the translations that
// minimise the rest. Fixed poses stay. Nothing where there is no unique solution: some pose is not joined to the fixed
// ones, or only by edges without weight.
std::optional<std::vector<Pose>> ChordalPoses(const PoseGraph& graph);

}  // namespace merlin
