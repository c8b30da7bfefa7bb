#include "scenarios/judge/laps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace merlin {
namespace {

constexpr double kAtCentre_m = 0.1;       // nearer than this the path does not wind around the centre
constexpr double kRounding_turns = 1e-9;  // so that a path that ends where it began has crossed the line

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Centroid of the area, for either order of the corners; none for an outline without area.
std::optional<Eigen::Vector2d> Centroid(const Outline& outline) {
  if (outline.size() < 3) return std::nullopt;
  const Eigen::Vector2d origin = outline.front();  // keeps the products small far from the world's origin
  double doubled_area_m2 = 0.0, size_m2 = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    const Eigen::Vector2d a = outline[i] - origin, b = outline[i + 1] - origin;
    doubled_area_m2 += Cross(a, b);
    moment += Cross(a, b) * (a + b) / 3.0;
    size_m2 = std::max({size_m2, a.squaredNorm(), b.squaredNorm()});
  }
  if (!(std::abs(doubled_area_m2) > 1e-9 * size_m2)) return std::nullopt;
  return origin + moment / doubled_area_m2;
}

// The starting line of laps.h, in a frame at the centre: n points towards the nearest outer wall, u to the left of n.
class StartingLine {
 public:
  StartingLine(const Eigen::Vector2d& start_centre, const OutlineWall& wall, double to_wall_m) {
    Eigen::Vector2d n = wall.Normal();
    if (n.dot(start_centre) < 0.0) n = -n;
    u_m_ = Cross(n, start_centre);
    n_min_m_ = std::max(n.dot(start_centre) - to_wall_m, 0.0);
    n_rad_ = std::atan2(n.y(), n.x());
  }
  // Angle of the line about the centre at a distance from it; a continuous function.
  double Angle_rad(double distance_m) const {
    const double n_m = std::sqrt(std::max(distance_m * distance_m - u_m_ * u_m_, n_min_m_ * n_min_m_));
    return n_rad_ + std::atan2(u_m_, n_m);
  }

 private:
  double u_m_, n_min_m_, n_rad_;
};

// Winding of the path in turns since it left the starting line; whole numbers are on the line.
class LapCount {
 public:
  // Forgets the winding so far: a lap takes at least a whole turn from here, and ends on the line.
  void Begin(double turns) {
    next_left_ = std::ceil(turns + 1.0 - kRounding_turns);
    next_right_ = std::floor(turns - 1.0 + kRounding_turns);
  }
  void MoveTo(double turns) {
    const bool left = turns > next_left_ - kRounding_turns, right = turns < next_right_ + kRounding_turns;
    if (!left && !right) return;
    ++laps_;
    Begin(left ? next_left_ : next_right_);
  }
  int laps() const { return laps_; }

 private:
  double next_left_ = 1.0, next_right_ = -1.0;
  int laps_ = 0;
};

}  // namespace

int CountLaps(const Trajectory& truth, const Outline& outline) {
  const std::optional<Eigen::Vector2d> centre = Centroid(outline);
  std::vector<Eigen::Vector2d> path;  // relative to the centre
  for (const StampedPose& pose : truth)
    if (centre && pose.T.translation().allFinite()) path.push_back(pose.T.translation().head<2>() - *centre);
  if (path.empty()) return 0;

  const Eigen::Vector2d start_world = path.front() + *centre;
  const std::vector<OutlineWall> walls = Walls(outline);
  const OutlineWall& nearest =
      *std::ranges::min_element(walls, {}, [&](const OutlineWall& wall) { return wall.Distance_m(start_world); });
  const StartingLine line(path.front(), nearest, nearest.Distance_m(start_world));

  LapCount count;
  double angle_rad = line.Angle_rad(path.front().norm());  // of the path about the centre, without jumps
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector2d &before = path[i - 1], &now = path[i];
    const bool at_centre = OutlineWall{before, now}.Distance_m(Eigen::Vector2d::Zero()) < kAtCentre_m;
    if (at_centre)
      angle_rad = std::atan2(now.y(), now.x());
    else
      angle_rad += std::atan2(Cross(before, now), before.dot(now));
    const double turns = (angle_rad - line.Angle_rad(now.norm())) / (2.0 * std::numbers::pi);
    if (at_centre)
      count.Begin(turns);
    else
      count.MoveTo(turns);
  }
  return count.laps();
}

}  // namespace merlin
