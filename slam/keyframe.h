// Key frames: the frames that the map is made of. Their poses are corrected when a loop closes, and every map can be
// made again from them.
#pragma once

#include <optional>
#include <vector>

#include "perception/observation.h"
#include "slam/map/clear_view.h"

namespace merlin {

// How far one frame saw, and from where. The frame was taken near a key frame, perhaps on a later visit.
struct PlacedView {
  Time stamp{0};
  Pose T_keyframe_base = Pose::Identity();
  ClearView view;
};

struct Keyframe {
  Time stamp{0};
  Pose T_map_base = Pose::Identity();       // as last corrected
  Pose T_previous_base = Pose::Identity();  // from the key frame before, as measured when this one was taken
  double path_m = 0.0;                      // distance driven until then
  std::optional<double> yaw_rad;            // by the heading alone, in the map; nothing without a compass
  double yaw_sigma_rad = 0.0;               // one standard deviation of it
  double view_yaw_rad = 0.0;                // direction of the camera, from straight ahead; positive: to the left
  std::vector<Point> points_base;
  Eigen::Vector3f camera_base{0, 0, 0};  // where the rays begin
  std::vector<PlacedView> views;         // its own first, then the newest of frames near it that are no key frames
  double in_local_map_m = 0.0;           // path_m at which its points were last put into the local map
  bool first_of_run = false;             // no step leads to it: T_previous_base says nothing
};

// Roughly the middle of what a key frame sees. Two key frames see the same place where their view centres are near, and
// not where the car stood near.
inline Eigen::Vector2d ViewCentre(const Pose& T_map_base) {
  constexpr double kAhead_m = 2.5;
  return (T_map_base * Eigen::Vector3d(kAhead_m, 0.0, 0.0)).head<2>();
}

}  // namespace merlin
