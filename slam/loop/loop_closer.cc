#include "slam/loop/loop_closer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr double kShortestStep_m = 0.01;  // a turn on the spot counts as this long
constexpr double kSameKeyframe_m = 0.3;   // up to this distance from the newest key frame a loop belongs to it

Matrix6d DiagonalInformation(double sigma_m, double sigma_rad) {
  Vector6d sigma;
  sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

bool Agree(const Pose& a, const Pose& b, const Eigen::Vector3d& at, double within) {
  const Pose apart = a.inverse() * b;
  return (a * at - b * at).norm() < within && std::abs(Yaw(apart)) < within;
}

// The loop, as an edge from the former key frame to the newest.
GraphEdge EdgeOf(std::span<const Keyframe> keyframes, const Loop& loop, const Pose& T_map_base,
                 const LoopConfig& config) {
  const Pose T_base_newest = T_map_base.inverse() * keyframes.back().T_map_base;
  GraphEdge edge{.from = loop.former, .to = keyframes.size() - 1};
  edge.T_from_to = keyframes[loop.former].T_map_base.inverse() * loop.T_map_base * T_base_newest;
  const Matrix6d least = DiagonalInformation(config.loop_sigma_m, config.loop_sigma_rad).inverse();
  const Matrix6d adjoint = Adjoint(T_base_newest.inverse());
  edge.information = (adjoint * loop.covariance * adjoint.transpose() + least).inverse();
  return edge;
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
  const std::optional<Loop> loop = FindLoop(keyframes, points_base, T_map_base, path_m, config_);
  if (!loop) {
    agreeing_ = 0;
    correction_.reset();
    return std::nullopt;
  }
  if (!Agrees(*loop, T_map_base)) return std::nullopt;
  if (path_m - keyframes.back().path_m > kSameKeyframe_m) {
    recognised_m_ = path_m;
    return std::nullopt;
  }
  PoseGraph graph = Graph(keyframes);
  const double before = Evaluate(graph, Objective::kB);
  graph.edges.push_back(EdgeOf(keyframes, *loop, T_map_base, config_));
  const OptimizeResult solved = Optimize(graph, {});
  if (!solved.converged || solved.objective - before > config_.strain_max) return std::nullopt;
  recognised_m_ = path_m;
  loops_.push_back(graph.edges.back());
  correction_ = Pose::Identity();  // the caller corrects the map
  return InPlane(keyframes, solved.poses);
}

void LoopCloser::Join(const std::vector<GraphEdge>& former, std::size_t former_keyframes,
                      std::span<const Keyframe> keyframes, const Loop& place, double path_m) {
  for (GraphEdge& edge : loops_) edge.from += former_keyframes, edge.to += former_keyframes;
  loops_.insert(loops_.begin(), former.begin(), former.end());
  loops_.push_back(EdgeOf(keyframes, place, place.T_map_base, config_));
  joined_ += former.size() + 1;
  recognised_m_ = searched_m_ = path_m;
  correction_.reset();
  agreeing_ = 0;
}

// Its poses are the key frames, then one at the map's origin, from which headings are measured.
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
    if (!keyframe.first_of_run)
      graph.edges.push_back(
          {i - 1, i, keyframe.T_previous_base,
           DiagonalInformation(config_.path_sigma_m_per_sqrt_m * root, config_.turn_sigma_rad_per_sqrt_m * root)});
    if (!keyframe.yaw_rad) continue;
    Matrix6d heading = Matrix6d::Zero();
    heading(5, 5) = 1.0 / (std::pow(config_.heading_sigma_rad, 2) + std::pow(keyframe.yaw_sigma_rad, 2));
    graph.edges.push_back({world, i, FromXyYaw(0.0, 0.0, *keyframe.yaw_rad), heading});
  }
  graph.poses.push_back(Pose::Identity());
  graph.edges.insert(graph.edges.end(), loops_.begin(), loops_.end());
  return graph;
}

}  // namespace merlin
