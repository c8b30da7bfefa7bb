// Colour onto points: each point takes the colour of the pixel it falls on (thesis eq. 4.16-4.18).
#pragma once

#include <span>

#include "perception/observation.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin {

// T_color_base maps the points' base frame, at their own instant, to the colour camera's optical frame at its exposure.
// Points behind the camera or outside its picture keep their state. Occlusion between the two views is not resolved.
void ColorPoints(std::span<Point> points_base, const ColorFrame& frame, const CameraModel& camera, const Pose& T_color_base);

}  // namespace merlin
