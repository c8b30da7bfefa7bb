// The obstacle stop with a panning camera: it remembers what it saw ahead while it looks aside.
#include "autonomy/seen_ahead.h"

#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/avoid.h"

namespace merlin {
namespace {

constexpr Footprint kCar{.front_m = 0.45, .half_width_m = 0.16};
constexpr double kHalfView_rad = 0.0873;  // 10 deg in total
const std::vector<Eigen::Vector2d> kAhead{{0.0, 0.0}, {4.0, 0.0}};

// The car at x, after t; the camera turned by yaw.
Observation Looks(double yaw_rad, double time_s, double x_m = 0.0) {
  Observation observation;
  observation.stamp = FromSeconds(time_s);
  observation.camera_base = {0.3f, 0.0f, 0.35f};
  observation.pans = true;
  observation.view_yaw_rad = yaw_rad;
  observation.half_view_rad = kHalfView_rad;
  observation.half_view_up_rad = 0.109;
  observation.T_odom_base = FromXyYaw(x_m, 0.0, 0.0);
  return observation;
}

// With five points at that height, ahead of the origin of the odom frame.
Observation WithPost(Observation observation, double x_m, double z_m = 0.35) {
  for (int i = 0; i < 5; ++i)
    observation.points_base.push_back(
        {.position = (observation.T_odom_base.inverse() * Eigen::Vector3d(x_m, 0.0, z_m)).cast<float>(),
         .sigma_m = 0.01f});
  return observation;
}

// Looks over the whole width of the path, in steps that overlap.
std::optional<double> Sweep(Avoid& avoid, double& time_s, double x_m = 0.0) {
  std::optional<double> free_m;
  for (double yaw_rad = -0.25; yaw_rad <= 0.25; yaw_rad += 0.125)
    free_m = avoid.FreeDistance_m(Looks(yaw_rad, time_s += 0.05, x_m), kAhead);
  return free_m;
}

TEST(SeenAhead, StandsUntilAllOfThePathWasLookedAt) {
  Avoid avoid(kCar, {});
  EXPECT_EQ(avoid.FreeDistance_m(Looks(0.0, 0.0), kAhead), 0.0) << "10 deg are less than the car's width";
  EXPECT_EQ(avoid.FreeDistance_m(Looks(0.2, 0.05), kAhead), 0.0);
  EXPECT_EQ(avoid.FreeDistance_m(Looks(0.125, 0.1), kAhead), 0.0);
  EXPECT_EQ(avoid.FreeDistance_m(Looks(-0.125, 0.15), kAhead), 0.0);
  EXPECT_FALSE(avoid.FreeDistance_m(Looks(-0.25, 0.2), kAhead)) << "nothing stands on it";
}

TEST(SeenAhead, LookingAsideStopsTheCarAfterOneSecond) {
  Avoid avoid(kCar, {});
  double time_s = 0.0;
  Sweep(avoid, time_s);
  EXPECT_FALSE(avoid.FreeDistance_m(Looks(1.0, time_s + 0.75), kAhead));
  EXPECT_EQ(avoid.FreeDistance_m(Looks(1.0, time_s + 1.05), kAhead), 0.0);
}

TEST(SeenAhead, LookingAsideStopsTheCarAfterThirtyCentimetres) {
  Avoid avoid(kCar, {});
  double time_s = 0.0;
  Sweep(avoid, time_s);
  EXPECT_FALSE(avoid.FreeDistance_m(Looks(1.0, time_s + 0.1, 0.29), kAhead));
  EXPECT_EQ(avoid.FreeDistance_m(Looks(1.0, time_s + 0.2, 0.31), kAhead), 0.0);
}

TEST(SeenAhead, RemembersAPostWhileTheCarDrivesTowardsIt) {
  Avoid avoid(kCar, {});
  double time_s = 0.0;
  Sweep(avoid, time_s);
  avoid.FreeDistance_m(WithPost(Looks(0.0, time_s += 0.05), 2.0), kAhead);
  const auto free_m = avoid.FreeDistance_m(Looks(0.6, time_s += 0.05, 0.2), kAhead);
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 2.0 - 0.2 - 0.45, 1e-6);
}

TEST(SeenAhead, ForgetsWhatHasGoneWhenItLooksAgain) {
  Avoid avoid(kCar, {.hold_s = 0.0});
  double time_s = 0.0;
  Sweep(avoid, time_s);
  EXPECT_TRUE(avoid.FreeDistance_m(WithPost(Looks(0.0, time_s += 0.05), 2.0), kAhead));
  EXPECT_TRUE(avoid.FreeDistance_m(Looks(0.3, time_s += 0.05), kAhead));
  EXPECT_FALSE(avoid.FreeDistance_m(Looks(0.0, time_s += 0.05), kAhead));
}

// At 0.7 m the view of 12.5 deg ends 0.27 m above the ground: a post of 0.1 m is below it.
TEST(SeenAhead, KeepsALowPostThatTheCameraLooksAcross) {
  Avoid avoid(kCar, {.hold_s = 0.0});
  double time_s = 0.0;
  avoid.FreeDistance_m(WithPost(Looks(0.0, time_s += 0.05), 2.7, 0.1), kAhead);
  for (double x_m = 0.1; x_m < 1.95; x_m += 0.1) Sweep(avoid, time_s, x_m);
  const auto free_m = Sweep(avoid, time_s, 1.9);
  ASSERT_TRUE(free_m);
  EXPECT_NEAR(*free_m, 2.7 - 1.9 - 0.45, 1e-6);
}

TEST(SeenAhead, CountsAFrameOnce) {
  SeenAhead seen;
  const Observation post = WithPost(Looks(0.0, 0.1), 2.0);
  seen.Add(post, 0.08, 0.6);
  seen.Add(post, 0.08, 0.6);
  EXPECT_EQ(seen.PointsBase().size(), 5u);
  seen.Add(WithPost(Looks(0.0, 0.2), 2.0, 0.7), 0.08, 0.6);
  EXPECT_TRUE(seen.PointsBase().empty()) << "above the car";
}

}  // namespace
}  // namespace merlin
