// The two objectives of the literature, as information matrices of a graph's edges.
//   A: sum of kappa |R_to - R_from R|^2 + tau |t_to - t_from - R_from t|^2, its rotations and translations isotropic
//      (D. Rosen et al., "SE-Sync", IJRR 2019): its optimum can be certified, and it gives the first guess
//   B: chi2 with the whole information matrix (R. Kuemmerle et al., "g2o", ICRA 2011): what the measurements say
#pragma once

#include "slam/graph/edge_error.h"
#include "slam/graph/pose_graph.h"

namespace merlin {

enum class Objective { kA, kB };

// Weights of an edge in A, from the information matrices It and Ir of translation and rotation as in a g2o file:
// tau = 2 / tr(It^-1), kappa = I33 in the plane; tau = 3 / tr(It^-1), kappa = 3 / (2 tr(Ir^-1)) in space. Zero for a
// singular matrix.
struct IsotropicWeights {
  double tau = 0.0, kappa = 0.0;
};
IsotropicWeights WeightsInA(const GraphEdge& edge, bool planar);

// The information of an edge for the errors of edge_error.h. In the plane the rotation is the chord in A, the angle in
// B.
Matrix6d InformationIn(Objective objective, const GraphEdge& edge, bool planar);
inline PlanarRotation PlanarRotationIn(Objective objective) {
  return objective == Objective::kA ? PlanarRotation::kChord : PlanarRotation::kAngle;
}

// The value of the objective at the graph's poses; every edge counts in full, robust or not.
double Evaluate(const PoseGraph& graph, Objective objective);

}  // namespace merlin
