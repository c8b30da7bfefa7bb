// Drives of the twin on an open floor, for calibrating its odometry and for judging that.
#pragma once

#include <string>
#include <vector>

#include "perception/calibrate_odometry.h"
#include "perception/odometry.h"
#include "scenarios/config/scenario.h"
#include "sim/world/materials.h"
#include "sim/world/world.h"

namespace merlin {

// What an operator with chalk and tape would measure of this car and write down: two straight drives, and circles to both
// sides, narrow and wide, each angle reached from below and from above. The tape errs by its sigma, by chance keyed by the
// seed.
MeasuredDrives DriveAndMeasure(const sim::WorldOptions& twin);

struct Manoeuvre {
  std::string name;
  double path_m = 0.0;
  double error_before_m = 0.0;  // of the odometry's last position, as the description has the car
  double error_after_m = 0.0;   // and as it was calibrated
};

// Circles and squares to both sides, of 2 m and more, driven by the calibrated odometry: how far off each odometry ends.
std::vector<Manoeuvre> DriveManoeuvres(const sim::WorldOptions& twin, const CarCalibration& calibration);

// The open floor with a scenario's car on it.
sim::WorldOptions OnOpenFloor(const Scenario& scenario);

}  // namespace merlin
