// Nearest neighbours of points that move a little from one query to the next, as in the iterations of ICP. The distance
// of the second nearest limits how far a point may move before another target point can be nearer. Until then the tree
// is not searched; by the triangle inequality the answers are still those of the tree.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "slam/register/neighbours.h"

namespace merlin {

class TrackedNeighbours {
 public:
  // Keeps references: the tree, and its positions, must outlive this. count: number of the points that move.
  TrackedNeighbours(const Neighbours& tree, std::span<const Eigen::Vector3d> positions, std::size_t count,
                    double reach_m)
      : tree_(tree), positions_(positions), reach_m_(reach_m), tracks_(count) {}

  // The nearest neighbour of point i, which is now at `query`; not farther than reach_m.
  std::optional<Neighbour> Nearest(std::size_t i, const Eigen::Vector3d& query);

 private:
  struct Track {
    Eigen::Vector3d asked_at = Eigen::Vector3d::Zero();
    double others_m = 0.0;  // distance of the second nearest from asked_at; 0: no search yet, or no neighbour
    std::uint32_t index = 0;
  };
  const Neighbours& tree_;
  std::span<const Eigen::Vector3d> positions_;
  double reach_m_;
  std::vector<Track> tracks_;
};

}  // namespace merlin
