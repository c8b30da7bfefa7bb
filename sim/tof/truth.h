// The truth about a frame, for tests and for studies of the camera. The stack cannot access it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot/types/se3.h"

namespace merlin::sim {

// Images are row-major, width x height, as the frame's.
struct TofTruth {
  int width = 0, height = 0;
  std::vector<float> range_m;       // along the pixel's middle ray at mid-exposure, not wrapped; 0: no hit
  std::vector<float> depth_m;       // optical z of the same point
  std::vector<int> geom;            // MuJoCo's id; -1: no hit
  std::vector<int> material;        // MuJoCo's id, -1: none
  std::vector<float> sigma_m;       // standard deviation of range that noise (and adc) will cause; 0 without them
  std::vector<std::uint8_t> mixed;  // 1: the pixel's sub-rays hit more than one surface during the frame
  struct Bias {
    std::string effect;
    std::vector<float> range_m;  // noise-free range with only this effect minus that with none
  };
  std::vector<Bias> bias;            // of every active effect that changes the mean
  std::vector<Pose> T_world_camera;  // [sub-frame] pose at its middle
};

}  // namespace merlin::sim
