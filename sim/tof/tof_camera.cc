#include "sim/tof/tof_camera.h"
