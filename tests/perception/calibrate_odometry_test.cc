#include "perception/calibrate_odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/perception/car.h"

namespace merlin {
namespace {

constexpr CarCalibration kTrue{.wheel_radius_m = 0.0538, .wheelbase_m = 0.341, .steering_offset_rad = 0.02};

// The path as the sum of many short steps of the car model; the distance is the one between its ends.
StraightDrive Straight(std::int64_t counts) {
  const double metres_per_count = 2.0 * std::numbers::pi * kTrue.wheel_radius_m / 5120.0;
  const double R = kTrue.wheelbase_m / std::tan(kTrue.steering_offset_rad);
  double mean = 0.0;  // of the four wheels' circles over the rear axle's middle's
  for (const double x : {0.0, kTrue.wheelbase_m})
    for (const double y : {-0.13, 0.13}) mean += std::hypot(x, R - y) / R / 4.0;
  const double step_m = static_cast<double>(counts) * metres_per_count / mean / 100000.0;
  double x = 0.0, y = 0.0, yaw = 0.0;
  for (int i = 0; i < 100000; ++i) {
    x += step_m * std::cos(yaw), y += step_m * std::sin(yaw);
    yaw += step_m / R;
  }
  return {counts, std::hypot(x, y)};
}

CircleDrive Circle(double steering_rad) {
  return {steering_rad, 2.0 * kTrue.wheelbase_m / std::abs(std::tan(steering_rad + kTrue.steering_offset_rad))};
}

MeasuredDrives Drives() {
  MeasuredDrives drives;
  drives.straights = {Straight(40000), Straight(75000)};
  drives.circles = {Circle(0.2), Circle(-0.2), Circle(0.35), Circle(-0.35)};
  return drives;
}

TEST(CalibrateOdometry, FindsTheCarExactlyFromExactDrives) {
  const OdometryCalibration found = CalibrateOdometry(Car(), Drives());
  EXPECT_EQ(found.problem, "");
  EXPECT_NEAR(found.value.wheel_radius_m, kTrue.wheel_radius_m, 1e-6);
  EXPECT_NEAR(found.value.wheelbase_m, kTrue.wheelbase_m, 1e-6);
  EXPECT_NEAR(found.value.steering_offset_rad, kTrue.steering_offset_rad, 1e-6);
  EXPECT_LT(found.residual_rms, 0.05);
}

TEST(CalibrateOdometry, ScattersAsMuchAsItSays) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  constexpr int kTimes = 400;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  const MeasuredDrives exact = Drives();
  for (int i = 0; i < kTimes; ++i) {
    MeasuredDrives drives = exact;
    for (StraightDrive& d : drives.straights) d.distance_m += drives.tape_sigma_m * normal(generator);
    for (CircleDrive& d : drives.circles) {
      d.diameter_m = 2.0 * kTrue.wheelbase_m /
                     std::abs(std::tan(d.steering_rad + kTrue.steering_offset_rad +
                                       drives.steering_sigma_rad * normal(generator)));
      d.diameter_m += drives.tape_sigma_m * normal(generator);
    }
    const OdometryCalibration found = CalibrateOdometry(Car(), drives);
    ASSERT_EQ(found.problem, "");
    squares += Eigen::Vector3d(
        std::pow((found.value.wheel_radius_m - kTrue.wheel_radius_m) / found.sigma.wheel_radius_m, 2),
        std::pow((found.value.wheelbase_m - kTrue.wheelbase_m) / found.sigma.wheelbase_m, 2),
        std::pow((found.value.steering_offset_rad - kTrue.steering_offset_rad) / found.sigma.steering_offset_rad, 2));
  }
  // Four sigmas of a variance from so many, and a quarter for weights taken at the described car.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(squares[i] / kTimes, 1.0, 4.0 * std::sqrt(2.0 / kTimes) + 0.25) << i;
}

TEST(CalibrateOdometry, NamesWhatIsMissing) {
  MeasuredDrives none;
  EXPECT_NE(CalibrateOdometry(Car(), none).problem.find("no straight"), std::string::npos);
  MeasuredDrives one_side = Drives();
  one_side.circles = {Circle(0.2), Circle(0.2)};
  EXPECT_NE(CalibrateOdometry(Car(), one_side).problem.find("to the left and to the right"), std::string::npos);
  MeasuredDrives no_circle = Drives();
  no_circle.circles.push_back({0.001, 600.0});
  EXPECT_NE(CalibrateOdometry(Car(), no_circle).problem.find("about zero"), std::string::npos);
}

TEST(CalibrateOdometry, NamesWhatTheDrivesDoNotDetermine) {
  MeasuredDrives wide = Drives();
  wide.steering_sigma_rad = 0.05;
  wide.circles = {Circle(0.06), Circle(-0.06)};
  EXPECT_NE(CalibrateOdometry(Car(), wide).problem.find("wheelbase"), std::string::npos);
  MeasuredDrives short_way = Drives();
  short_way.tape_sigma_m = 0.1;
  short_way.straights = {Straight(8000)};
  EXPECT_NE(CalibrateOdometry(Car(), short_way).problem.find("wheel radius"), std::string::npos);
}

TEST(CalibrateOdometry, NamesDrivesThatContradictEachOther) {
  MeasuredDrives drives = Drives();
  drives.straights[0].distance_m *= 1.1;
  EXPECT_NE(CalibrateOdometry(Car(), drives).problem.find("contradict"), std::string::npos);
}

}  // namespace
}  // namespace merlin
