// Experiments that compare the simulated camera with a law, or with another method of computing the same thing. Each study
// switches on only the effects that it is about, and gives one figure.
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

// Throws InputError for an unknown study; the message names the most similar one.
void CheckStudyName(const std::string& name);

Figure Study(const std::string& name, const StudyCamera& camera);

}  // namespace merlin
