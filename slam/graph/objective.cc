#include "slam/graph/objective.h"

#include <Eigen/Eigenvalues>

namespace merlin {
namespace {

// tr(M^-1) of a symmetric matrix; infinite for a singular one.
template <class Matrix>
double TraceOfInverse(const Matrix& M) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(M, Eigen::EigenvaluesOnly);
  const auto& values = solver.eigenvalues();
  const double least = 1e-14 * values.maxCoeff();  // below: rounding of a zero
  return values.minCoeff() > least ? values.cwiseInverse().sum() : HUGE_VAL;
}

template <class Group>
double EvaluateIn(const PoseGraph& graph, Objective objective) {
  double sum = 0.0;
  for (const GraphEdge& edge : graph.edges) {
    const auto error = Group::Error(Group::Of(graph.poses[edge.from]), Group::Of(graph.poses[edge.to]),
                                    Group::Of(edge.T_from_to), PlanarRotationIn(objective));
    const Matrix6d information = InformationIn(objective, edge, graph.planar);
    sum += error.dot(Group::Part(information) * error);
  }
  return sum;
}

}  // namespace

IsotropicWeights WeightsInA(const GraphEdge& edge, bool planar) {
  if (planar) {
    const Eigen::Matrix2d It = edge.information.topLeftCorner<2, 2>();
    return {.tau = 2.0 / TraceOfInverse(It), .kappa = edge.information(5, 5)};
  }
  const Eigen::Matrix3d It = edge.information.topLeftCorner<3, 3>();
  const Eigen::Matrix3d Ir = 4.0 * edge.information.bottomRightCorner<3, 3>();  // of a file, over half our rotation
  return {.tau = 3.0 / TraceOfInverse(It), .kappa = 3.0 / (2.0 * TraceOfInverse(Ir))};
}

Matrix6d InformationIn(Objective objective, const GraphEdge& edge, bool planar) {
  if (objective == Objective::kB) return edge.information;
  const IsotropicWeights weights = WeightsInA(edge, planar);
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(weights.tau);
  information.diagonal().tail<3>().setConstant(2.0 * weights.kappa);  // |R - I|^2 = 2 (2 sin(angle / 2))^2
  return information;
}

double Evaluate(const PoseGraph& graph, Objective objective) {
  return graph.planar ? EvaluateIn<Planar>(graph, objective) : EvaluateIn<Spatial>(graph, objective);
}

}  // namespace merlin
