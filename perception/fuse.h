// Colours points: each point takes the colour of the pixel that it projects to ("Autonomous navigation and mapping of
// mobile robots based on 2D/3D cameras combination", thesis, University of Siegen, about 2011, eq. 4.16-4.18). The
// colour camera sees from another place, so a point that another one hides from it gets no colour: a depth buffer of
// the points decides. Surfaces without a point (saturated, or too dark) hide nothing.
#pragma once

#include <span>

#include "perception/observation.h"
#include "robot/types/measurements.h"
#include "robot/types/se3.h"

namespace merlin {

// T_color_base: from the base frame at the points' instant to the colour camera's optical frame at its exposure.
// pixel_rad: angle between neighbouring pixels of the depth camera, (0, 1]; each point hides what is behind a square of
// this size. Points that are hidden, behind the colour camera or outside its picture stay as they are.
void ColorPoints(std::span<Point> points_base, const ColorFrame& frame, const CameraModel& camera,
                 const Pose& T_color_base, double pixel_rad);

}  // namespace merlin
