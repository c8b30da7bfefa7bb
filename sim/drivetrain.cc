#include "sim/drivetrain.h"
