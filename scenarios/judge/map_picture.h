// The picture of a run: the map from above over the true plan, with the true and the estimated path.
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

// A PNG file's bytes, 1400 pixels wide, world x to the right and y up. Points are coloured by their height, those above
// the ceiling's height of 2.5 m as the ones at it. What is not finite is left out.
std::string ToPng(const MapPicture& picture);

}  // namespace merlin
