// Estimates wheel radius, wheelbase and steering offset from drives that an operator has measured with a tape: straight
// ones, and circles to both sides. Weighted least squares, solved by Gauss-Newton.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot/base/config.h"
#include "robot/types/car_calibration.h"

namespace merlin {

// From rest to rest, with the servo at zero. The distance is measured on the floor between the start and end points
// below the rear axle's middle. With a steering offset the path between them is a shallow arc.
struct StraightDrive {
  std::int64_t encoder_counts = 0;  // [100, 1e12] counted on it, forwards
  double distance_m = 0.0;          // [0.5, 1000]
};

template <class Visitor>
void Visit(Visitor& v, StraightDrive& c) {
  v("encoder_counts", c.encoder_counts, {100.0, 1e12});
  v("distance_m", c.distance_m, {0.5, 1000.0});
}

// A circle at one steering angle. Approach the angle from both sides in turn, so that the play of the linkage averages
// out.
struct CircleDrive {
  double steering_rad = 0.0;  // [-1.2, 1.2] as the servo reports it, positive: left
  double diameter_m = 0.0;    // [0.1, 1000] of the path of the rear axle's middle
};

template <class Visitor>
void Visit(Visitor& v, CircleDrive& c) {
  v("steering_rad", c.steering_rad, {-1.2, 1.2});
  v("diameter_m", c.diameter_m, {0.1, 1000.0});
}

struct MeasuredDrives {
  double tape_sigma_m = 0.0015;        // [0.0001, 0.1] one sigma of a measured length
  double steering_sigma_rad = 0.0015;  // [0.0001, 0.1] one sigma of the wheels' angle at a reported angle: play
  std::vector<StraightDrive> straights;
  std::vector<CircleDrive> circles;
};

template <class Visitor>
void Visit(Visitor& v, MeasuredDrives& c) {
  v("tape_sigma_m", c.tape_sigma_m, {0.0001, 0.1});
  v("steering_sigma_rad", c.steering_sigma_rad, {0.0001, 0.1});
  v("straights", c.straights);
  v("circles", c.circles);
}

struct OdometryCalibration {
  std::string problem;  // empty: solved; else one sentence, and nothing below is valid
  CarCalibration value;
  CarCalibration sigma;     // one standard deviation of each value
  double residual_rms = 0;  // in sigmas; about 1 or less where model, measurements and sigmas agree
  int iterations = 0;
};

// Starts at the described values. Drives that do not determine a value (circles to one side only, no straight one) or
// that contradict each other are reported as a problem.
OdometryCalibration CalibrateOdometry(const CarDescription& described, const MeasuredDrives& drives);

}  // namespace merlin
