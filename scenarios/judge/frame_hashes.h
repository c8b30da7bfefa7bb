// Hashes and counts of the frames as they were delivered: stamps and buffers.
#pragma once

#include <cstdint>

#include "robot/base/sha256.h"
#include "robot/types/color_camera.h"
#include "robot/types/depth_camera.h"

namespace merlin {

struct FrameHashes {
  Sha256 depth, color;
  std::int64_t depth_frames = 0, color_frames = 0;
  void Add(const DepthFrame& frame);
  void Add(const ColorFrame& frame);
};

}  // namespace merlin
