// Which voxels hold something that is no longer there, or only passed by: other frames looked right through them.
#pragma once

#include <span>
#include <vector>

#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/map/voxel_map.h"

namespace merlin {

// One a voxel, true: it moved away. All sights of the key frames are asked, in the order of time. What three in a row looked
// through has gone; what came after such three must be seen twice to stay. A sight says nothing of a voxel that it does not
// see, or has something before, or that lies along its rays (dark pixels: that does not face them rather well). What the
// middle of the car passed through has gone too: low and near, where cameras do not see.
std::vector<bool> MovedAway(std::span<const Voxel> voxels, std::span<const Keyframe> keyframes,
                            const Footprint& footprint);

}  // namespace merlin
