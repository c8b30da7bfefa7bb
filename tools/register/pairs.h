// The pairs of clouds that `merlin bench register` aligns: a simulated pair with a known pose, and real ones.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "robot/types/se3.h"
#include "slam/register/cloud.h"

namespace merlin {

struct RegisterPair {
  std::string name;
  Cloud source, target;
  Pose T_target_source = Pose::Identity();  // the truth; for real pairs the estimate of another system
  Pose guess = Pose::Identity();
};

// Two clouds of 70,000 points: a place of 70 x 60 m (ground, walls around it, houses, poles, trees) as a spinning lidar with
// 64 beams and 2 cm of range noise sees it from two poses that are 1.4 m and 6 degrees apart. Each cloud is in the frame of
// its own pose. Always the same bits.
RegisterPair SimulatedPair();

// Each two successive frames of the five in that folder (depth/1.pgm ... 5.pgm and pose.txt), with every pixel between 0.3
// and 6 m, and an initial guess that is wrong by 15 cm and 5 degrees. Frames 1 and 2 overlap too little and are left out.
// Empty if the folder does not exist.
std::vector<RegisterPair> RgbdPairs(const std::filesystem::path& folder);

}  // namespace merlin
