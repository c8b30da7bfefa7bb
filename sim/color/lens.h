// A distorting lens. The renderer knows pinholes only, so a larger pinhole picture is drawn and then resampled once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "robot/types/camera_model.h"

namespace merlin::sim {

class Lens {
 public:
  // camera: invertible (CameraModel::IsInvertible).
  explicit Lens(const CameraModel& camera);

  // The camera without distortion, of the same focal lengths, whose picture holds the direction of every pixel.
  // Without distortion it is the camera itself.
  const CameraModel& pinhole() const { return pinhole_; }

  // From the pinhole's picture to the camera's: each pixel takes what lies along its own ray, bilinear between the
  // pinhole's pixels, its place rounded to 1/256 pixel. Both BGR, row-major. In integers: the same bits everywhere.
  void Remap(std::span<const std::uint8_t> pinhole_bgr, std::span<std::uint8_t> bgr) const;

 private:
  struct Place {
    std::uint32_t first;                // byte of the upper left of the four pixels
    std::uint16_t right_256, down_256;  // shares of the right and the lower ones
  };
  CameraModel pinhole_;
  std::vector<Place> places_;  // by pixel; empty without distortion
};

}  // namespace merlin::sim
