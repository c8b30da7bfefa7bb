#include "sim/color_camera.h"
