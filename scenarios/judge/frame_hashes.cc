#include "scenarios/judge/frame_hashes.h"

#include <span>

namespace merlin {

void FrameHashes::Add(const DepthFrame& frame) {
  ++depth_frames;
  depth.Add(frame.stamp.count());
  depth.Add(std::span<const float>(frame.range_m));
  depth.Add(std::span<const float>(frame.amplitude));
  depth.Add(std::span<const std::uint8_t>(frame.intensity));
  depth.Add(std::span<const std::uint8_t>(frame.flags));
}

void FrameHashes::Add(const ColorFrame& frame) {
  ++color_frames;
  color.Add(frame.stamp.count());
  color.Add(std::span<const std::uint8_t>(frame.bgr));
}

}  // namespace merlin
