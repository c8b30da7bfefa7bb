// Perception, as one sentence: each depth frame is filtered, projected to points in the car's frame, and coloured by
// the newest colour frame; wheel odometry and heading at its stamp go with it. The steps follow "Autonomous navigation
// and mapping of mobile robots based on 2D/3D cameras combination", thesis, University of Siegen, about 2011.
//
//   in                        step                                     out
//   DepthFrame                filter/depth_filter, project             points in the base frame, each with its sigma
//   ColorFrame                fuse                                     their colours
//   DriveState                odometry                                 T_odom_base
//   CompassReading            heading                                  yaw in the world, with its sigma
//   PanState, turntable       angle_track                              where the camera points, where the car is turned
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "perception/angle_track.h"
#include "perception/filter/depth_filter.h"
#include "perception/fuse.h"
#include "perception/heading.h"
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
  double color_age_max_s = 0.3;  // [0, 10] a colour frame farther than this from the depth frame colours no points
};

template <class Visitor>
void Visit(Visitor& v, PerceptionConfig& c) {
  v("filter", c.filter);
  v("integration", c.integration);
  v("heading", c.heading);
  v("color_age_max_s", c.color_age_max_s, {0.0, 10.0});
}

// The devices: data sheets and mounting poses.
struct Rig {
  CarDescription car;
  DepthCameraSheet depth;
  Pose T_base_depth = Pose::Identity();
  std::optional<ColorCameraSheet> color;  // none: no colour
  Pose T_base_color = Pose::Identity();
  bool pans = false;          // a pan unit turns the cameras; their poses above are those at its angle zero
  bool on_turntable = false;  // the car is on a turntable, whose turn the wheels do not measure
};

class Pipeline {
 public:
  Pipeline(Rig rig, const PerceptionConfig& config);
  // Measurements of each device, in the order of their stamps. Those that are not finite are left out.
  void Add(const DriveState& state);
  void Add(const CompassReading& reading);
  void Add(std::shared_ptr<const ColorFrame> frame);
  void AddPan(const PanState& state) { pan_.Add(state); }
  void AddTurntable(const PanState& state) { turntable_.Add(state); }
  // Nothing before the first reading of the wheels, and of pan unit and turntable where the car has them.
  std::optional<Observation> Process(DepthFrame frame);

 private:
  std::optional<Pose> OdomAt(Time time) const;                               // T_odom_base, with the turntable's turn
  std::optional<Pose> CameraAt(const Pose& T_base_camera, Time time) const;  // at the pan unit's angle

  Rig rig_;
  PerceptionConfig config_;
  std::vector<Eigen::Vector3f> rays_;
  FieldOfView view_;
  Odometry odometry_;
  Heading heading_;
  AngleTrack pan_, turntable_;
  std::shared_ptr<const ColorFrame> color_;
};

}  // namespace merlin
