// The plan that a map is compared with: the outer outline of a room, in the world frame, floor at z = 0.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace merlin {

// Corners [m] in order, clockwise or counter-clockwise; the last is joined to the first. Fewer than three: no outline.
using Outline = std::vector<Eigen::Vector2d>;

// One outer wall: the outline's edge from a to b.
struct OutlineWall {
  Eigen::Vector2d a_m;
  Eigen::Vector2d b_m;

  double Length_m() const { return (b_m - a_m).norm(); }
  Eigen::Vector2d Along() const { return (b_m - a_m).normalized(); }
  // Unit vector to the right of the edge, which points outward if the corners run counter-clockwise.
  Eigen::Vector2d Normal() const { return {Along().y(), -Along().x()}; }
  // Signed distance of p from the wall's line, positive on the normal's side.
  double Offset_m(const Eigen::Vector2d& p) const { return Normal().dot(p - a_m); }
  // Distance of p from the wall itself, its ends included.
  double Distance_m(const Eigen::Vector2d& p) const {
    const double s_m = std::clamp(Along().dot(p - a_m), 0.0, Length_m());
    return (p - a_m - s_m * Along()).norm();
  }
};

// Walls in the order of the outline; none for fewer than three corners. A repeated corner makes no wall.
inline std::vector<OutlineWall> Walls(const Outline& outline) {
  std::vector<OutlineWall> walls;
  if (outline.size() < 3) return walls;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const OutlineWall wall{outline[i], outline[(i + 1) % outline.size()]};
    if (wall.Length_m() > 0.0) walls.push_back(wall);
  }
  return walls;
}

}  // namespace merlin
