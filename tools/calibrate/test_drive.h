// Test drives of the simulated car on an open floor. Some imitate what an operator measures to calibrate the odometry; others
// show how good the odometry is before and after the calibration.
#pragma once

#include <string>
#include <vector>

#include "perception/calibrate_odometry.h"
#include "perception/odometry.h"
#include "scenarios/config/scenario.h"
#include "sim/world/materials.h"
#include "sim/world/world.h"

namespace merlin {

// What an operator with chalk and a tape measure would write down about this car: two straight drives, and narrow and wide
// circles to both sides. Each steering angle is reached once from below and once from above, so that the play of the
// linkage cancels. The tape has a random error (MeasuredDrives::tape_sigma_m), drawn from the world's seed.
MeasuredDrives DriveAndMeasure(const sim::WorldOptions& twin);

struct Manoeuvre {
  std::string name;
  double path_m = 0.0;
  // How far the odometry's last position is from the true one:
  double error_before_m = 0.0;  // with the car as it is described
  double error_after_m = 0.0;   // with the car as it is calibrated
};

// Drives circles and squares (sides of 2 m) to the left and to the right, steered by the calibrated odometry, and measures
// the error of both odometries at the end of each.
std::vector<Manoeuvre> DriveManoeuvres(const sim::WorldOptions& twin, const CarCalibration& calibration);

// A world of a scenario's car on an open floor.
sim::WorldOptions OnOpenFloor(const Scenario& scenario);

}  // namespace merlin
