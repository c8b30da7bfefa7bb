// Clouds as files: PLY and PCD (binary), CSV. Coordinates are 32-bit floats where that keeps each point within 0.05 mm,
// which holds some 1000 m around the origin; else doubles (national grids). CSV has digits enough for doubles.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "slam/register/cloud.h"

namespace merlin {

using Rgb = std::array<std::uint8_t, 3>;

// The file's bytes: PCD or CSV where the name ends so, else PLY. rgb: a colour a point, or none (then they are light
// grey, as in a run's map).
std::string ToCloud(const std::filesystem::path& name, std::span<const Eigen::Vector3d> positions,
                    std::span<const Rgb> rgb);

}  // namespace merlin
