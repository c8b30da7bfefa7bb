// Writes point clouds as binary PLY, binary PCD or CSV. Coordinates are 32-bit floats if that moves no point by more than
// 0.05 mm, which is so up to about 1000 m from the origin, and doubles otherwise (for example in national grids). CSV has as
// many digits as a double needs.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "slam/register/cloud.h"

namespace merlin {

using Rgb = std::array<std::uint8_t, 3>;

// The bytes of the file. The ending of the name selects PCD or CSV; anything else gives PLY. rgb: one colour per point, or
// empty: all points are light grey, as in the map of a run.
std::string ToCloud(const std::filesystem::path& name, std::span<const Eigen::Vector3d> positions,
                    std::span<const Rgb> rgb);

}  // namespace merlin
