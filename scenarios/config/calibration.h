// The car's calibration, and the drives it comes from, as files.
#pragma once

#include <filesystem>
#include <string>

#include "perception/calibrate_odometry.h"
#include "robot/types/car_calibration.h"

namespace merlin {

// The keys of CarCalibration, all of them. Throws InputError: file and line, unknown key (names the nearest), missing one,
// a value out of its range: all faults at once.
CarCalibration ReadCalibration(const std::filesystem::path& file);
std::string ToYaml(const CarCalibration& calibration);

// The keys of MeasuredDrives: `straights: [{encoder_counts: 74112, distance_m: 5.003}]`,
// `circles: [{steering_rad: 0.25, diameter_m: 2.61}]`. Throws as above.
MeasuredDrives ReadDrives(const std::filesystem::path& file);

}  // namespace merlin
