// The hardware abstraction layer: five devices and a clock, a page each. Simulated, replayed and real robots are structs
// of these; the stack never meets anything else. No call blocks but Clock::WaitUntil; threads belong to the plugs.
#pragma once

#include "robot/hal/clock.h"
#include "robot/hal/color_camera.h"
#include "robot/hal/compass.h"
#include "robot/hal/depth_camera.h"
#include "robot/hal/drive.h"
#include "robot/hal/pan_unit.h"

namespace merlin {

// A device the robot lacks is a null pointer. The plug that made them owns them and outlives this struct. The stack drives
// by one camera of each kind.
struct Robot {
  Clock* clock = nullptr;  // never null
  DepthCamera* depth = nullptr;
  ColorCamera* color = nullptr;
  Compass* compass = nullptr;
  Drive* drive = nullptr;
  PanUnit* pan = nullptr;        // turns the cameras
  PanUnit* turntable = nullptr;  // turns the car that stands on it
};

}  // namespace merlin
