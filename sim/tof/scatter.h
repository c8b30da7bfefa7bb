// Light reflected back and forth between lens and chip: every pixel gets a little of the light of all others, with
// their phases (Kavli et al., "Modelling and compensating measurement errors caused by scattering in time-of-flight
// cameras", SPIE 7066, 2008).
#pragma once

#include <span>
#include <vector>

#include "robot/types/depth_camera_errors.h"

namespace merlin::sim {

class Scatter {
 public:
  Scatter(int width, int height, const DepthCameraErrors& errors);
  // image' = (1 - s) image + s (PSF * image), in place. Light beyond the edge of the image is lost; the uniform part of
  // the PSF is the mean. It acts on the phasors, because the correlation images are linear in them.
  void Apply(std::span<float> image) const;

 private:
  int width_, height_;
  float share_, flat_;
  std::vector<float> kernel_;  // Gaussian part, from the middle to one side
};

}  // namespace merlin::sim
