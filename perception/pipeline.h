// Perception as one sentence: filter, odometry, project, fuse.
#pragma once

#include <optional>
#include <vector>

#include "perception/angle_track.h"
#include "perception/filter/depth_filter.h"
#include "perception/fuse.h"
#include "perception/integration_time.h"
#include "perception/observation.h"
#include "perception/odometry.h"
#include "perception/project.h"
#include "robot/types/car.h"
#include "robot/types/depth_camera.h"
#include "robot/types/measurements.h"

namespace merlin {

struct PerceptionConfig {
  DepthFilterConfig filter;
  IntegrationConfig integration;
  HeadingConfig heading;
  double color_age_max_s = 0.3;  // [0, 10] older pictures colour no points
};

template <class Visitor>
void Visit(Visitor& v, PerceptionConfig& c) {
  v("filter", c.filter);
  v("integration", c.integration);
  v("heading", c.heading);
  v("color_age_max_s", c.color_age_max_s, {0.0, 10.0});
}

// What the devices are: the sheets, and where they sit.
struct Rig {
  CarDescription car;
  DepthCameraSheet depth;
  Pose T_base_depth = Pose::Identity();
  std::optional<ColorCameraSheet> color;  // none: no colour
  Pose T_base_color = Pose::Identity();
  bool pans = false;          // a pan unit turns the cameras: their poses are those while it looks ahead
  bool on_turntable = false;  // the car stands on a turntable: what that turns, the wheels do not know
};

class Pipeline {
 public:
  Pipeline(Rig rig, const PerceptionConfig& config);
  // States and readings that are not finite are left out.
  void Add(const DriveState& state);
  void Add(const CompassReading& reading);
  void Add(ColorFrame frame);
  void AddPan(const PanState& state) { pan_.Add(state); }
  void AddTurntable(const PanState& state) { turntable_.Add(state); }
  // Nothing until wheel odometry, and pan unit and turntable where there are such, have reported for the first time.
  std::optional<Observation> Process(DepthFrame frame);

 private:
  std::optional<Pose> OdomAt(Time time) const;  // T_odom_base, with the turn of the turntable
  std::optional<Pose> CameraAt(const Pose& T_base_camera, Time time) const;  // as the pan unit stands

  Rig rig_;
  PerceptionConfig config_;
  std::vector<Eigen::Vector3f> rays_;
  Odometry odometry_;
  Heading heading_;
  AngleTrack pan_, turntable_;
  std::optional<ColorFrame> color_;
};

}  // namespace merlin
