// Perception as one sentence: filter, odometry, project, fuse.
#pragma once

#include <optional>
#include <vector>

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
  OdometryConfig odometry;
  HeadingConfig heading;
  double color_age_max_s = 0.3;  // [0, 10] older pictures colour no points
};

template <class Visitor>
void Visit(Visitor& v, PerceptionConfig& c) {
  v("filter", c.filter);
  v("integration", c.integration);
  v("odometry", c.odometry);
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
};

class Pipeline {
 public:
  Pipeline(Rig rig, const PerceptionConfig& config);
  // States and readings that are not finite are left out.
  void Add(const DriveState& state);
  void Add(const CompassReading& reading);
  void Add(ColorFrame frame);
  // Nothing until wheel odometry has begun.
  std::optional<Observation> Process(DepthFrame frame);

 private:
  Rig rig_;
  PerceptionConfig config_;
  std::vector<Eigen::Vector3f> rays_;
  Odometry odometry_;
  Heading heading_;
  std::optional<ColorFrame> color_;
};

}  // namespace merlin
