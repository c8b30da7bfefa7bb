#include "slam/register/tracked_neighbours.h"

#include <array>
#include <cmath>

namespace merlin {
namespace {

// Distances are rounded.
constexpr double kSurely = 1.0 - 1e-9;

}  // namespace

std::optional<Neighbour> TrackedNeighbours::Nearest(std::size_t i, const Eigen::Vector3d& query) {
  Track& track = tracks_[i];
  if (track.others_m > 0.0) {
    const double squared_m2 = (positions_[track.index] - query).squaredNorm();
    const double moved_m = (query - track.asked_at).norm();
    if (std::sqrt(squared_m2) + moved_m < kSurely * track.others_m && squared_m2 <= reach_m_ * reach_m_)
      return Neighbour{squared_m2, track.index};
  }
  std::array<Neighbour, 2> found;
  const std::size_t count = tree_.Nearest(query, found, reach_m_);
  if (count == 0) {
    track.others_m = 0.0;
    return std::nullopt;
  }
  track = {query, count == 2 ? std::sqrt(found[1].squared_m2) : reach_m_, found[0].index};
  return found[0];
}

}  // namespace merlin
