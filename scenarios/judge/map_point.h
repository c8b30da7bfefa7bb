// One point of a finished map.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace merlin {

struct MapPoint {
  Eigen::Vector3f p_map = Eigen::Vector3f::Zero();  // [m]
  std::array<std::uint8_t, 3> rgb{200, 200, 200};   // red, green, blue
};

}  // namespace merlin
