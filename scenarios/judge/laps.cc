#include "scenarios/judge/laps.h"

#include <cstdlib>
#include <optional>

namespace merlin {
namespace {

constexpr double kCornerReach_m = 2.5;  // the middle of a 2 m corridor passes its outer corner at 1.4 m
constexpr double kStartReach_m = 1.0;

// The nearest corner within reach.
std::optional<int> CornerAt(const Eigen::Vector2d& position_m, const Outline& outline) {
  std::optional<int> nearest;
  double nearest_m = kCornerReach_m;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const double distance_m = (outline[i] - position_m).norm();
    if (distance_m > nearest_m) continue;
    nearest_m = distance_m;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

// Corners passed since the lap began, counted around the outline with sign: the first is 0, the next 1 or -1.
class CornerCount {
 public:
  explicit CornerCount(int corners) : corners_(corners) {}

  void Pass(int corner) {
    const int step = last_ == kNone ? 0 : (corner - last_ + corners_) % corners_;
    if (step == 1) {
      ++turns_;
    } else if (step == corners_ - 1) {
      --turns_;
    } else if (step != 0) {
      turns_ = 0;
    }
    last_ = corner;
  }
  bool AllPassed() const { return std::abs(turns_) >= corners_ - 1; }

 private:
  static constexpr int kNone = -1;
  int corners_;
  int turns_ = 0;
  int last_ = kNone;
};

}  // namespace

int CountLaps(const Trajectory& truth, const Outline& outline) {
  if (outline.size() < 3 || truth.empty()) return 0;
  const Eigen::Vector2d start_m = truth.front().T.translation().head<2>();
  CornerCount count(static_cast<int>(outline.size()));
  int laps = 0;
  for (const StampedPose& pose : truth) {
    const Eigen::Vector2d position_m = pose.T.translation().head<2>();
    if (const std::optional<int> corner = CornerAt(position_m, outline)) count.Pass(*corner);
    if (count.AllPassed() && (position_m - start_m).norm() <= kStartReach_m) {
      ++laps;
      count = CornerCount(static_cast<int>(outline.size()));
    }
  }
  return laps;
}

}  // namespace merlin
