// Files of the car's calibration and of the measured drives that it is computed from.
#pragma once

#include <filesystem>
#include <string>

#include "perception/calibrate_odometry.h"
#include "robot/types/car_calibration.h"

namespace merlin {

// Reads the keys of CarCalibration; all are required. Throws InputError with file and line for an unknown key (and
// suggests the nearest), a missing key, or a value out of range. It lists all faults at once.
CarCalibration ReadCalibration(const std::filesystem::path& file);
std::string ToYaml(const CarCalibration& calibration);

// Reads the keys of MeasuredDrives: `straights: [{encoder_counts: 74112, distance_m: 5.003}]`,
// `circles: [{steering_rad: 0.25, diameter_m: 2.61}]`. Throws as above.
MeasuredDrives ReadDrives(const std::filesystem::path& file);

}  // namespace merlin
