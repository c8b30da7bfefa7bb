// The contents of the files of a run, as bytes. They are hashed as they are and written in one piece (WriteFile).
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

// One line per pose: "stamp_s x y z qx qy qz qw" with nine decimals and qw >= 0 (format of the TUM RGB-D benchmark).
std::string ToTum(const Trajectory& trajectory);

// Binary little-endian PLY: x y z (float) [m], red green blue (uchar).
std::string ToPly(std::span<const MapPoint> map);

// Occupancy grid, seen from above. cells: width x height, row by row, beginning with the lowest y; -1 is unknown, else
// the probability [%] that the cell is occupied, 0 to 100.
struct GridMap {
  int width = 0;
  int height = 0;
  double resolution_m = 0.05;
  Eigen::Vector2d origin_m{0.0, 0.0};  // the grid's corner of lowest x and y, in the map's frame
  std::vector<std::int8_t> cells{};
};

// The two files that ROS 2's nav2_map_server reads: a picture (PGM, top row at the highest y; free 254, occupied 0,
// unknown 205) and its description, which names the file of the picture.
std::string ToPgm(const GridMap& grid);
std::string ToMapYaml(const GridMap& grid, const std::string& pgm_name);

}  // namespace merlin
