// Experiments with one model of camera: samples of the simulated camera over what a law or another way of computing
// says.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "tools/camera/figure.h"

namespace merlin {

struct StudyCamera {
  DepthCameraSheet sheet;
  DepthCameraErrors errors;
  DepthSettings settings;
  std::uint64_t seed = 1;
  int threads = 1;
};

std::vector<std::string> StudyNames();

// Throws InputError for an unknown study, naming the nearest.
void CheckStudyName(const std::string& name);

// With only the effects switched on that the study is about.
Figure Study(const std::string& name, const StudyCamera& camera);

}  // namespace merlin
