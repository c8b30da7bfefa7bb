#include "autonomy/path_ahead.h"

#include <algorithm>

namespace merlin {

PathAcross AcrossPath(std::span<const Eigen::Vector2d> path_base, double distance_m, double half_width_m) {
  Eigen::Vector2d at = path_base.front(), along = Eigen::Vector2d::UnitX();
  double left_m = distance_m;
  for (std::size_t i = 0; i + 1 < path_base.size() && left_m > 0.0; ++i) {
    const Eigen::Vector2d step = path_base[i + 1] - path_base[i];
    const double length_m = step.norm();
    if (length_m == 0.0) continue;
    along = step / length_m;
    at = path_base[i] + std::min(left_m, length_m) * along;
    left_m -= length_m;
  }
  const Eigen::Vector2d to_left(-along.y(), along.x());
  PathAcross across;
  for (std::size_t i = 0; i < across.size(); ++i)
    across[i] = at + half_width_m * (2.0 * static_cast<double>(i) / (across.size() - 1.0) - 1.0) * to_left;
  return across;
}

}  // namespace merlin
