// Light that is reflected to and fro between lens and chip: every pixel gets a little of the light of all others, with
// their phases (Kavli et al.,
// "Modelling and compensating measurement errors caused by scattering in time-of-flight cameras", SPIE 7066, 2008).
#pragma once

#include <span>
#include <vector>

#include "robot/types/depth_camera_errors.h"

namespace merlin::sim {

class Scatter {
 public:
  Scatter(int width, int height, const DepthCameraErrors& errors);
  // image' = (1 - s) image + s (PSF * image), in place. What leaves the picture is lost; the even part is the mean. The
  // correlation images of the sub-frames are linear in the phasors: to scatter these is to scatter those.
  void Apply(std::span<float> image) const;

 private:
  int width_, height_;
  float share_, flat_;
  std::vector<float> kernel_;  // of the Gaussian part, one side from the middle on
};

}  // namespace merlin::sim
