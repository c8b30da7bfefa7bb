// Finds the voxels whose content is no longer there, or only passed by: other frames saw free space through them. A
// simplified occupancy mapping (H. Moravec and A. Elfes, "High resolution maps from wide angle sonar", ICRA 1985), with
// range images in place of cells.
#pragma once

#include <span>
#include <vector>

#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/map/voxel_map.h"

namespace merlin {

// One entry per voxel; true: its content moved away. Takes all views of the key frames in the order of time. A voxel
// through which three views in a row saw has moved away; what comes after these must be seen twice to stay. A view says
// nothing about a voxel outside it, behind something else, or with a surface nearly parallel to its rays (for dark
// pixels: one that does not face them well). Voxels that the middle of the car passed through have moved away too: they
// are low and near, where cameras do not see. What no later view covers stays: when a visitor who stood close before the
// car steps aside, the upper body is above the view, which reaches 0.6 m high at 0.9 m.
std::vector<bool> MovedAway(std::span<const Voxel> voxels, std::span<const Keyframe> keyframes,
                            const Footprint& footprint);

}  // namespace merlin
