// Writes a frame and its truth in file formats that other programs read.
#pragma once

#include <map>
#include <string>

#include "robot/types/depth_camera.h"
#include "tools/camera/measure.h"

namespace merlin {

// File names and their bytes: phase_images, range, amplitude, intensity, flags, truth_* (range, depth, geom, material, sigma, mixed,
// T_world_optical), bias_<effect>, all .npy; range.png (16 bit, millimetres, 0: invalid); cloud.ply (the camera as a
// body: x forward, y left, z up, coloured by amplitude).
std::map<std::string, std::string> FrameFiles(const Measurement& measurement, const CameraModel& camera);

}  // namespace merlin
