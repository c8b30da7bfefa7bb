// One frame as a person looks at it.
#pragma once

#include <string>

#include "tools/camera/measure.h"

namespace merlin {

// A PNG: true range, measured range, error, amplitude, each with its scale. Grey: nothing there, or invalid.
std::string ToPng(const Measurement& measurement, const std::string& title, const std::string& subtitle);

}  // namespace merlin
