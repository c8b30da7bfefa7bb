// Lens distortion. The renderer draws pinhole pictures only, so a larger one is drawn and resampled once.
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

  // The pinhole camera to draw with: the same focal lengths, and a picture large enough for the rays of all pixels. It
  // is the camera itself if that has no distortion.
  const CameraModel& pinhole() const { return pinhole_; }

  // Resamples the pinhole picture to the camera's, both BGR and row-major. Each pixel takes the colour along its own
  // ray, interpolated bilinearly at a position rounded to 1/256 pixel. Integer arithmetic gives the same bits
  // everywhere.
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
