// The colour camera of "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination", thesis,
// University of Siegen, about 2011, with the calibration found there. Many tests use it.
#pragma once

#include "robot/types/camera_model.h"

namespace merlin {

inline const CameraModel kThesisCcd{.width = 640,
                                    .height = 480,
                                    .fx_px = 780.037,
                                    .fy_px = 777.844,
                                    .cx_px = 353.244,
                                    .cy_px = 223.784,
                                    .k1 = 0.024,
                                    .k2 = 0.015,
                                    .p1 = -0.006,
                                    .p2 = 0.0109};

}  // namespace merlin
