// Frames that the map is made of.
#pragma once

#include <optional>
#include <vector>

#include "perception/observation.h"
#include "slam/map/clear_view.h"

namespace merlin {

// How far a frame saw, and from where; a frame of another key frame's place, maybe of a later visit.
struct Sight {
  Time stamp{0};
  Pose T_keyframe_base = Pose::Identity();
  ClearView view;
};

struct Keyframe {
  Time stamp{0};
  Pose T_map_base = Pose::Identity();       // as last corrected
  Pose T_previous_base = Pose::Identity();  // from the key frame before, as measured when it was taken
  double path_m = 0.0;                      // driven until then
  std::optional<double> yaw_rad;            // by the heading alone, in the map; none: no compass
  double yaw_sigma_rad = 0.0;
  std::vector<Point> points_base;
  Eigen::Vector3f camera_base{0, 0, 0};
  std::vector<Sight> sights;    // its own, and the last few of frames that are here, but no key frames
  double in_local_map_m = 0.0;  // path at which its points were last put into the local map
};

// The middle of what it sees, about: what two key frames have in common is a matter of these rather than of where they stand.
inline Eigen::Vector2d ViewCentre(const Pose& T_map_base) {
  constexpr double kAhead_m = 2.5;
  return (T_map_base * Eigen::Vector3d(kAhead_m, 0.0, 0.0)).head<2>();
}

}  // namespace merlin
