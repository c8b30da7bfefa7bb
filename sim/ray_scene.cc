#include "sim/ray_scene.h"
