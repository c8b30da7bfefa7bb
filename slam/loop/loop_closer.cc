#include "slam/loop/loop_closer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace merlin {
namespace {

constexpr double kShortestStep_m = 0.01;  // a turn on the spot counts as this long
constexpr double kSameKeyframe_m = 0.3;   // up to this distance from the newest key frame a loop belongs to it
// Chi2 from which a loop loses weight: 95 % of the right ones with 3 degrees of freedom lie below. An edge is let go where
// it would raise the least chi2 by three times as much or more, about chi2_max.
constexpr OptimizeConfig kRobust{.robust_chi2 = 7.81};

Matrix6d DiagonalInformation(double sigma_m, double sigma_rad) {
  Vector6d sigma;
  sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

bool Agree(const Pose& a, const Pose& b, const Eigen::Vector3d& at, double within) {
  const Pose apart = a.inverse() * b;
  return (a * at - b * at).norm() < within && std::abs(Yaw(apart)) < within;
}

// Index of the newest key frame of that distance driven.
std::size_t KeyframeAt(std::span<const Keyframe> keyframes, double path_m) {
  const auto later = std::ranges::upper_bound(keyframes, path_m, {}, &Keyframe::path_m);
  return later == keyframes.begin() ? 0 : static_cast<std::size_t>(later - keyframes.begin()) - 1;
}

// The loop, as an edge from the former key frame to another one, which is near the present pose.
GraphEdge EdgeOf(std::span<const Keyframe> keyframes, const Loop& loop, std::size_t to, const Pose& T_map_base,
                 const LoopConfig& config, bool robust = true) {
  const Pose T_base_newest = T_map_base.inverse() * keyframes[to].T_map_base;
  GraphEdge edge{.from = loop.former, .to = to};
  edge.T_from_to = keyframes[loop.former].T_map_base.inverse() * loop.T_map_base * T_base_newest;
  const Matrix6d least = DiagonalInformation(config.loop_sigma_m, config.loop_sigma_rad).inverse();
  const Matrix6d adjoint = Adjoint(T_base_newest.inverse());
  edge.information = (adjoint * loop.covariance * adjoint.transpose() + least).inverse();
  edge.robust = robust;
  return edge;
}

double Chi2(const PoseGraph& graph, const std::vector<Pose>& poses, const GraphEdge& edge) {
  return Evaluate({.poses = poses, .edges = {edge}, .planar = graph.planar}, Objective::kB);
}

// The solved poses in the plane, with height, roll and pitch as before.
std::vector<Pose> InPlane(std::span<const Keyframe> keyframes, const std::vector<Pose>& solved) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Pose& before = keyframes[i].T_map_base;
    const Pose flat = FromXyYaw(before.translation().x(), before.translation().y(), Yaw(before));
    const Pose now = FromXyYaw(solved[i].translation().x(), solved[i].translation().y(), Yaw(solved[i]));
    poses.push_back(now * flat.inverse() * before);
  }
  return poses;
}

}  // namespace

bool LoopCloser::Agrees(const Loop& loop, const Pose& T_map_base) {
  const Pose correction = loop.T_map_base * T_map_base.inverse();
  agreeing_ =
      correction_ && Agree(*correction_, correction, T_map_base.translation(), config_.agreeing_m) ? agreeing_ + 1 : 1;
  correction_ = correction;
  return agreeing_ >= config_.agreeing_min;
}

std::optional<std::vector<Pose>> LoopCloser::Search(std::span<const Keyframe> keyframes,
                                                    std::span<const Point> points_base, const Pose& T_map_base,
                                                    double path_m) {
  searched_m_ = path_m;
  return Take(keyframes, FindLoop(keyframes, points_base, T_map_base, path_m, config_), T_map_base, path_m);
}

std::optional<std::vector<Pose>> LoopCloser::Take(std::span<const Keyframe> keyframes, const std::optional<Loop>& loop,
                                                  const Pose& T_map_base, double path_m) {
  if (!loop) {
    agreeing_ = 0;
    correction_.reset();
    return std::nullopt;
  }
  if (!Agrees(*loop, T_map_base)) return std::nullopt;
  if (path_m - keyframes[KeyframeAt(keyframes, path_m)].path_m > kSameKeyframe_m) {
    recognised_m_ = path_m;
    return std::nullopt;
  }
  auto poses = Close(keyframes, *loop, T_map_base, path_m);
  if (!poses) return std::nullopt;
  recognised_m_ = path_m;
  correction_ = Pose::Identity();  // the caller corrects the map
  return poses;
}

std::optional<std::vector<Pose>> LoopCloser::Close(std::span<const Keyframe> keyframes, const Loop& loop,
                                                   const Pose& T_map_base, double path_m) {
  PoseGraph graph = Graph(keyframes);
  const GraphEdge newest = EdgeOf(keyframes, loop, KeyframeAt(keyframes, path_m), T_map_base, config_);
  std::vector<Pose> alone;
  if (DriftChi2(graph, newest, alone) > config_.chi2_max) return std::nullopt;
  const std::size_t others = graph.edges.size();
  std::ranges::copy_if(edges_, std::back_inserter(graph.edges), &GraphEdge::robust);
  if (graph.edges.size() == others) graph.poses = alone;  // the optimum, unless it lets go of the edge
  edges_.push_back(newest);
  graph.edges.push_back(newest);
  OptimizeResult solved = Optimize(graph, kRobust);
  const bool holds = Chi2(graph, solved.poses, newest) <= config_.chi2_max;
  if (!solved.converged || !holds) return std::nullopt;
  const auto refuted = [&](const GraphEdge& edge) {
    return edge.robust && Chi2(graph, solved.poses, edge) > config_.chi2_max;
  };
  const bool all_hold = std::erase_if(graph.edges, refuted) == 0;
  loops_ = static_cast<int>(graph.edges.size() - others);
  if (!all_hold) solved = Optimize(graph, kRobust);
  return InPlane(keyframes, solved.poses);
}

void LoopCloser::Join(const std::vector<GraphEdge>& former, std::size_t former_keyframes,
                      std::span<const Keyframe> keyframes, const Loop& place, double path_m) {
  for (GraphEdge& edge : edges_) edge.from += former_keyframes, edge.to += former_keyframes;
  edges_.insert(edges_.begin(), former.begin(), former.end());
  edges_.push_back(EdgeOf(keyframes, place, keyframes.size() - 1, place.T_map_base, config_, false));
  const int former_loops = static_cast<int>(std::ranges::count(former, true, &GraphEdge::robust));
  joined_ += former_loops;
  loops_ += former_loops;
  recognised_m_ = searched_m_ = path_m;
  correction_.reset();
  agreeing_ = 0;
}

// By how much the edge raises the least chi2 of the graph. In the linear problem this is its Mahalanobis distance: its
// difference from what the graph says, weighted by the inverse of the sum of both covariances.
double LoopCloser::DriftChi2(PoseGraph graph, const GraphEdge& edge, std::vector<Pose>& poses) const {
  const OptimizeResult without = Optimize(graph, {});
  graph.poses = without.poses;
  graph.edges.push_back(edge);
  graph.edges.back().robust = false;
  const OptimizeResult with = Optimize(graph, {});
  poses = with.poses;
  return without.converged && with.converged ? with.objective - without.objective : HUGE_VAL;
}

// Without loops, but with the places that join runs. Its poses are the key frames, then one at the map's origin, from
// which headings are measured.
PoseGraph LoopCloser::Graph(std::span<const Keyframe> keyframes) const {
  PoseGraph graph;
  graph.planar = true;
  const std::size_t world = keyframes.size();
  graph.fixed = {0, world};
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& keyframe = keyframes[i];
    graph.poses.push_back(keyframe.T_map_base);
    if (i == 0) continue;
    const double root = std::sqrt(std::max(keyframe.path_m - keyframes[i - 1].path_m, kShortestStep_m));
    if (!keyframe.first_of_run) {
      const double corner_rad =
          keyframe.yaw_rad ? 0.0
                           : config_.corner_sigma_rad_per_sqrt_rad * std::sqrt(std::abs(Yaw(keyframe.T_previous_base)));
      graph.edges.push_back({i - 1, i, keyframe.T_previous_base,
                             DiagonalInformation(config_.path_sigma_m_per_sqrt_m * root,
                                                 std::hypot(config_.turn_sigma_rad_per_sqrt_m * root, corner_rad))});
    }
    if (!keyframe.yaw_rad) continue;
    Matrix6d heading = Matrix6d::Zero();
    heading(5, 5) = 1.0 / (std::pow(config_.heading_sigma_rad, 2) + std::pow(keyframe.yaw_sigma_rad, 2));
    graph.edges.push_back({world, i, FromXyYaw(0.0, 0.0, *keyframe.yaw_rad), heading});
  }
  graph.poses.push_back(Pose::Identity());
  std::ranges::copy_if(edges_, std::back_inserter(graph.edges), [](const GraphEdge& edge) { return !edge.robust; });
  return graph;
}

}  // namespace merlin
