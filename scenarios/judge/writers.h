// The files a run leaves, as bytes. Text is made first and written whole (WriteFile), so that what is hashed is what is
// written.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "robot/base/files.h"
#include "robot/types/trajectory.h"
#include "scenarios/judge/map_point.h"

namespace merlin {

// One line a pose: "stamp_s x y z qx qy qz qw", nine decimals, qw >= 0 (the TUM RGB-D benchmark's format).
std::string ToTum(const Trajectory& trajectory);

// Binary little-endian PLY: x y z (float) [m], red green blue (uchar).
std::string ToPly(std::span<const MapPoint> map);

// A map from above. cells: width x height, row by row, the row of the lowest y first; -1 unknown, else the chance [%]
// that the cell is occupied, 0 to 100.
struct GridMap {
  int width = 0;
  int height = 0;
  double resolution_m = 0.05;
  Eigen::Vector2d origin_m{0.0, 0.0};  // the grid's corner of lowest x and y, in the map's frame
  std::vector<std::int8_t> cells{};
};

// The pair of files ROS 2's nav2_map_server reads: a picture (PGM, upper row the highest y; free 254, occupied 0,
// unknown 205) and its description, which names the picture's file.
std::string ToPgm(const GridMap& grid);
std::string ToMapYaml(const GridMap& grid, const std::string& pgm_name);

}  // namespace merlin
