#include "sim/compass.h"
