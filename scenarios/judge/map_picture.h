// The picture of a run: the map seen from above, the true plan, and the true and the estimated path.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "robot/types/se3.h"
#include "robot/types/trajectory.h"
#include "scenarios/judge/map_point.h"
#include "scenarios/judge/map_size.h"
#include "scenarios/judge/outline.h"

namespace merlin {

struct MapPicture {
  std::string title{};              // ASCII: the scenario and the seed
  std::span<const MapPoint> map{};  // may be empty
  Pose T_world_map = Pose::Identity();
  Outline outline{};      // may be empty
  Trajectory truth{};     // T_world_base; may be empty
  Trajectory estimate{};  // T_map_base; may be empty
  MapSize size{};
  std::optional<double> ate_rmse_m{};
};

// The bytes of a PNG file, 1400 pixels wide, with world x to the right and y up. Points are coloured by height, up to
// the ceiling's 2.5 m. Values that are not finite are left out.
std::string ToPng(const MapPicture& picture);

}  // namespace merlin
