// Reports a measurement, as text for people and as JSON for programs.
#pragma once

#include <string>

#include "tools/camera/measure.h"

namespace merlin {

// Keys: model, settings{...}, center{range_mean_m, range_sigma_m, samples}, middle{same}, valid_share, saturated_share,
// amplitude_mean, frame_ms. A value is null where there are too few samples. effects: as the user named them.
std::string ToJson(const Measurement& measurement, const Shooting& shooting, const std::string& effects);

// "20 frames of 1000 us at 20 + 30 MHz, effects all, seed 1".
std::string SettingsLine(const Shooting& shooting, const std::string& effects);

std::string Summary(const Measurement& measurement);

}  // namespace merlin
