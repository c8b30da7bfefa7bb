// Colour onto points: each point takes the colour of the pixel it falls on (thesis eq. 4.16-4.18), unless the colour camera,
// which looks from elsewhere, has something nearer in that place. What has no point (saturated, or too dark) hides nothing.
#pragma once

#include <span>

#include "perception/observation.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin {

// T_color_base maps the points' base frame, at their own instant, to the colour camera's optical frame at its exposure.
// pixel_rad: the angle between neighbouring points as their depth camera saw them, (0, 1]: each hides what lies behind a
// square of that size. Points that are hidden, behind the camera or outside its picture keep their state.
void ColorPoints(std::span<Point> points_base, const ColorFrame& frame, const CameraModel& camera,
                 const Pose& T_color_base, double pixel_rad);

}  // namespace merlin
