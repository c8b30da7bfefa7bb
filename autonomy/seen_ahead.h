// What a camera that a pan unit turns has seen ahead of the car. While the camera looks aside, the obstacle stop goes by
// this memory.
//
// Points stay where they were seen, in the odom frame. A point is forgotten where a newer frame looks at its place again,
// and once the car has driven on. A point that the camera cannot look at any more, such as a low one close to the car,
// stays: it may still be there.
//
// The memory also tells how long ago, and how far back, the camera has looked at each part of the path ahead. A lens that
// sees 10 deg covers 16 cm at a distance of 0.9 m. That is less than the width of the car, so that one look does not
// show the whole path there, and each part counts by itself.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "autonomy/path_ahead.h"
#include "perception/observation.h"
#include "robot/types/time.h"

namespace merlin {

class SeenAhead {
 public:
  // Once per frame, before anything is asked; a frame that was added already changes nothing. Points below or above
  // these heights are left out.
  void Add(const Observation& observation, double height_min_m, double height_max_m);

  // The points ahead that were seen by now, in the base frame of the newest frame.
  std::vector<Point> PointsBase() const;

  // For the part of the path that the camera looked at longest ago: how long ago, and how far the car has driven since.
  // Infinite where the camera has never looked at a part. across: in the base frame of the newest frame.
  struct Age {
    double time_s = 0.0, driven_m = 0.0;
  };
  Age OldestLook(const PathAcross& across);

 private:
  struct Look {
    Time stamp{0};
    double path_m = 0.0;
  };
  bool Sees(const Eigen::Vector2d& point_base) const;
  void ForgetWhatIsSeenAgain();

  std::vector<Point> points_odom_;
  std::array<std::optional<Look>, std::tuple_size_v<PathAcross>> looks_;
  // Of the newest frame.
  Time stamp_{-1};
  Pose T_odom_base_ = Pose::Identity();
  Eigen::Vector3d camera_base_{0, 0, 0};
  double view_yaw_rad_ = 0.0, half_view_rad_ = 0.0, half_view_up_rad_ = 0.0;
  double path_m_ = 0.0;  // driven since the first frame
};

}  // namespace merlin
