#include "sim/renderer.h"
