// Nearest neighbours of points that move a little from one question to the next, as those of an iteration do. The
// distance of the second nearest bounds how far a point may move before another target point can be nearer; until then
// the tree is not asked. The answers are those of the tree, by the triangle inequality.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/register/neighbours.h"

namespace merlin {

class TrackedNeighbours {
 public:
  // Keeps references: tree and positions, those of the tree, must outlive it. `count` points ask, as 0 ... count - 1.
  TrackedNeighbours(const Neighbours& tree, std::span<const Eigen::Vector3d> positions, std::size_t count,
                    double reach_m)
      : tree_(tree), positions_(positions), reach_m_(reach_m), tracks_(count) {}

  // Point i's nearest neighbour now that it is at `query`; none farther than reach_m.
  std::optional<Neighbour> Nearest(std::size_t i, const Eigen::Vector3d& query);

 private:
  struct Track {
    Eigen::Vector3d asked_at = Eigen::Vector3d::Zero();
    double others_m = 0.0;  // no other position is nearer to asked_at; 0: not asked yet, or without a neighbour
    std::uint32_t index = 0;
  };
  const Neighbours& tree_;
  std::span<const Eigen::Vector3d> positions_;
  double reach_m_;
  std::vector<Track> tracks_;
};

}  // namespace merlin
