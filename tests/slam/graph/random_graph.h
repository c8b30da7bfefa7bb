// Small graphs for tests.
#pragma once

#include <numbers>
#include <random>

#include "slam/graph/pose_graph.h"

namespace merlin {

class RandomGraphs {
 public:
  explicit RandomGraphs(unsigned seed) : generator_(seed) {}

  double Normal(double sigma = 1.0) { return sigma * std::normal_distribution<double>()(generator_); }

  Vector6d Tangent(double translation_m, double rotation_rad, bool planar = false) {
    Vector6d tangent;
    for (double& value : tangent) value = Normal();
    if (planar) tangent(2) = tangent(3) = tangent(4) = 0.0;
    tangent.head<3>() *= translation_m;
    tangent.tail<3>() *= rotation_rad;
    return tangent;
  }

  // Symmetric, positive definite, far from diagonal.
  Matrix6d Information() {
    Matrix6d root;
    for (double& value : root.reshaped()) value = Normal();
    return root * root.transpose() + 0.1 * Matrix6d::Identity();
  }

  // A walk, and as many more edges between random pairs of its poses. The edges have errors of this size.
  PoseGraph Walk(int poses, double noise, bool planar) {
    PoseGraph graph{.poses = {Pose::Identity()}, .edges = {}, .fixed = {}, .planar = planar};
    for (int i = 1; i < poses; ++i) graph.poses.push_back(graph.poses.back() * Exp(Tangent(1.0, 0.7, planar)));
    std::uniform_int_distribution<std::size_t> any(0, static_cast<std::size_t>(poses) - 1);
    for (std::size_t i = 0; i + 1 < graph.poses.size(); ++i) Join(graph, i, i + 1, noise);
    for (int i = 0; i < poses; ++i) {
      const std::size_t a = any(generator_), b = any(generator_);
      if (a != b) Join(graph, a, b, noise);
    }
    return graph;
  }

  void Join(PoseGraph& graph, std::size_t from, std::size_t to, double noise) {
    GraphEdge edge{.from = from, .to = to, .information = Information()};
    edge.T_from_to = graph.poses[from].inverse() * graph.poses[to] * Exp(Tangent(noise, noise, graph.planar));
    graph.edges.push_back(edge);
  }

 private:
  std::mt19937 generator_;
};

}  // namespace merlin
