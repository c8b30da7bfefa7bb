// Which voxels hold something that is no longer there, or only passed by: other frames looked right through them.
#pragma once

#include <span>
#include <vector>

#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/map/voxel_map.h"

namespace merlin {

// One a voxel, true: it moved away. The last looks decide, in the order of the key frames' sights, which is that of time: what
// three of them in a row looked through has gone; what came later than such three must be seen twice to stay. Sights that do
// not see a voxel, or see something before it, say nothing. What stood where the car then drove has gone, too: what is nearer
// than the cameras see.
std::vector<bool> MovedAway(std::span<const Voxel> voxels, std::span<const Keyframe> keyframes, const Footprint& footprint);

}  // namespace merlin
