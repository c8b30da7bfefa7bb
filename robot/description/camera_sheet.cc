#include "robot/description/description.h"
