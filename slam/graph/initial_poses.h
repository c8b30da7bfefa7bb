// First guesses for a graph whose poses are unknown or bad.
#pragma once

#include <optional>
#include <vector>

#include "slam/graph/pose_graph.h"

namespace merlin {

// Poses along the edges, from the fixed ones on, over the spanning tree whose edges join the nearest indices: the chain
// of odometry where there is one. Poses that no edge reaches stay.
std::vector<Pose> ChainedPoses(const PoseGraph& graph);

// Chordal initialisation (L. Carlone et al., "Initialization techniques for 3D SLAM", ICRA 2015): the matrices that
// minimise the rotations' part of objective A, the nearest rotations to them, then the translations that minimise the
// rest. Fixed poses stay. Nothing where that has no single answer (some pose is not joined to the fixed ones, or by
// edges without weight).
std::optional<std::vector<Pose>> ChordalPoses(const PoseGraph& graph);

}  // namespace merlin
