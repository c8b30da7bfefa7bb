#include "sim/materials.h"
