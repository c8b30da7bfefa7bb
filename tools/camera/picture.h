// Draws one frame for people.
#pragma once

#include <string>

#include "tools/camera/measure.h"

namespace merlin {

// A PNG of four images, each with its colour scale: true range, measured range, error and amplitude. Grey pixels are
// invalid, or see nothing.
std::string ToPng(const Measurement& measurement, const std::string& title, const std::string& subtitle);

}  // namespace merlin
