// Wheel radius, wheelbase and steering offset from drives that an operator has measured with a tape.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot/base/config.h"
#include "robot/types/car_calibration.h"

namespace merlin {

// From a standing start to a stop, the servo at zero. Taped from mark to mark under the rear axle's middle; where the
// steering has an offset the way between is a shallow arc.
struct StraightDrive {
  std::int64_t encoder_counts = 0;  // [100, 1e12] in it, forwards
  double distance_m = 0.0;          // [0.5, 1000]
};

template <class Visitor>
void Visit(Visitor& v, StraightDrive& c) {
  v("encoder_counts", c.encoder_counts, {100.0, 1e12});
  v("distance_m", c.distance_m, {0.5, 1000.0});
}

// At one steering angle. Approach it from either side in turn: so the play of the linkage averages out.
struct CircleDrive {
  double steering_rad = 0.0;  // [-1.2, 1.2] as the servo reports it, positive: left
  double diameter_m = 0.0;    // [0.1, 1000] taped across the track of the rear axle's middle
};

template <class Visitor>
void Visit(Visitor& v, CircleDrive& c) {
  v("steering_rad", c.steering_rad, {-1.2, 1.2});
  v("diameter_m", c.diameter_m, {0.1, 1000.0});
}

struct MeasuredDrives {
  double tape_sigma_m = 0.0015;        // [0.0001, 0.1] of one measured length
  double steering_sigma_rad = 0.0015;  // [0.0001, 0.1] of the wheels' angle for a reported one: play
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
  std::string problem;  // empty: solved; else one sentence, and nothing below holds
  CarCalibration value;
  CarCalibration sigma;     // one standard deviation of each, from the two sigmas above
  double residual_rms = 0;  // in sigmas: about 1 or less where model, tape and sigmas agree
  int iterations = 0;
};

// Least squares over the drives (Gauss-Newton from the described values). Drives that leave a value open (one side only,
// no straight one) or contradict each other are a problem, named.
OdometryCalibration CalibrateOdometry(const CarDescription& described, const MeasuredDrives& drives);

}  // namespace merlin
