// Pairs of clouds that `merlin bench register` aligns: a simulated one whose pose is known, and real ones.
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
  Pose T_target_source = Pose::Identity();  // true; of the real ones, another system's estimate
  Pose guess = Pose::Identity();
};

// 70,000 points each: a place of 70 x 60 m (ground, walls around it, houses, poles, trees) as a spinning lidar of 64
// beams with 2 cm of range noise sees it, each in its own frame, from two places 1.4 m and 6 degrees apart. The same
// bits every time.
RegisterPair SimulatedPair();

// Neighbours of the five frames in that folder (depth/1.pgm ... 5.pgm and pose.txt), every pixel between 0.3 and 6 m,
// guessed 15 cm and 5 degrees off; without the pair 1-2, which overlaps too little to judge. None where the folder is
// absent.
std::vector<RegisterPair> RgbdPairs(const std::filesystem::path& folder);

}  // namespace merlin
