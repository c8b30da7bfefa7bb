// A twin that differs from its description calibrates itself, with errors of the tape and backlash.
#include "tools/calibrate/test_drive.h"

#include <gtest/gtest.h>

namespace merlin {
namespace {

sim::WorldOptions Twin(const DrivetrainConfig& drivetrain, std::uint64_t seed = 1) {
  Scenario scenario;
  scenario.car.drivetrain = drivetrain;
  scenario.seed = seed;
  return OnOpenFloor(scenario);
}

TEST(CalibrationInTheTwin, RecoversAWrongCarFromTapedDrives) {
  for (const DrivetrainConfig& wrong :
       {DrivetrainConfig{.steering_offset_rad = 0.02, .wheel_radius_factor = 0.97, .wheelbase_factor = 1.04},
        DrivetrainConfig{.steering_offset_rad = -0.03, .wheel_radius_factor = 1.02, .wheelbase_factor = 0.95},
        DrivetrainConfig{}})
    for (const std::uint64_t seed : {1u, 2u}) {
      const sim::WorldOptions twin = Twin(wrong, seed);
      const OdometryCalibration found = CalibrateOdometry(twin.car, DriveAndMeasure(twin));
      ASSERT_EQ(found.problem, "");
      const double radius_m = wrong.wheel_radius_factor * twin.car.wheel_radius_m;
      const double wheelbase_m = wrong.wheelbase_factor * twin.car.wheelbase_m;
      EXPECT_NEAR(found.value.wheel_radius_m, radius_m, 0.002 * radius_m);
      EXPECT_NEAR(found.value.wheelbase_m, wheelbase_m, 0.01 * wheelbase_m);
      EXPECT_NEAR(found.value.steering_offset_rad, wrong.steering_offset_rad, 0.0015);
      EXPECT_LT(found.residual_rms, 2.0);
    }
}

TEST(CalibrationInTheTwin, LeavesAPercentOfTheWayAsErrorAndFarLessThanBefore) {
  const sim::WorldOptions twin =
      Twin({.steering_offset_rad = 0.015, .wheel_radius_factor = 0.98, .wheelbase_factor = 1.03});
  const OdometryCalibration found = CalibrateOdometry(twin.car, DriveAndMeasure(twin));
  ASSERT_EQ(found.problem, "");
  const std::vector<Manoeuvre> manoeuvres = DriveManoeuvres(twin, found.value);
  ASSERT_EQ(manoeuvres.size(), 4u);
  for (const Manoeuvre& m : manoeuvres) {
    EXPECT_GT(m.path_m, 8.0) << m.name;
    EXPECT_LE(m.error_after_m, 0.01 * m.path_m) << m.name;
    EXPECT_LT(m.error_after_m, 0.5 * m.error_before_m) << m.name;
  }
}

TEST(CalibrationInTheTwin, GivesTheSameMeasurementsForTheSameSeedOnly) {
  const auto first = [](std::uint64_t seed) { return DriveAndMeasure(Twin({}, seed)).circles.front().diameter_m; };
  EXPECT_EQ(first(1), first(1));
  EXPECT_NE(first(1), first(2));
}

}  // namespace
}  // namespace merlin
