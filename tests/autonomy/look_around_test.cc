#include "autonomy/look_around.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/autonomy/car.h"

namespace merlin {
namespace {

constexpr double kPeriod_s = 0.05, kNarrow_rad = 0.0873, kWide_rad = 0.349;
const std::vector<Eigen::Vector2d> kStraightOn{{0.0, 0.0}, {4.0, 0.0}};

Observation At(int frame, double half_view_rad) {
  Observation observation;
  observation.stamp = FromSeconds(kPeriod_s * frame);
  observation.camera_base = {0.3f, 0.0f, 0.35f};
  observation.pans = true;
  observation.half_view_rad = half_view_rad;
  return observation;
}

// A car with a pan unit that turns by 90 deg to either side, at 3.2 rad/s.
CarDescription PanningCar() {
  CarDescription car = Car();
  car.links.emplace_back().name = "camera_pan";
  car.links[1].joint_min_rad = -0.5 * std::numbers::pi;
  car.links[1].joint_max_rad = 0.5 * std::numbers::pi;
  car.pan = CarPan{.link = 1, .slew_rad_s = 3.2, .moves = true};
  return car;
}

std::vector<double> Angles(LookAround& look, double half_view_rad, const std::optional<PathAcross>& across,
                           bool lost = false) {
  std::vector<double> angles;
  for (int frame = 0; frame < 200; ++frame)
    angles.push_back(look.Next_rad(At(frame, half_view_rad), across, lost).value());
  return angles;
}

TEST(LookAround, AWideLensHoldsStraightAhead) {
  LookAround look(PanningCar(), {});
  for (const double angle_rad : Angles(look, kWide_rad, AcrossPath(kStraightOn, 1.2, 0.24))) EXPECT_EQ(angle_rad, 0.0);
  EXPECT_EQ(look.SpeedLimit_m_s(0.3), HUGE_VAL);
}

TEST(LookAround, SaysNothingWherePanningIsNotPossible) {
  LookAround look(PanningCar(), {});
  Observation fixed = At(0, kNarrow_rad);
  fixed.pans = false;
  EXPECT_FALSE(look.Next_rad(fixed, std::nullopt, false));
}

TEST(LookAround, ANarrowLensSeesAsFarToTheSidesAsAWideOne) {
  LookAround look(PanningCar(), {});
  const std::vector<double> angles = Angles(look, kNarrow_rad, AcrossPath(kStraightOn, 1.2, 0.24));
  const auto [right, left] = std::ranges::minmax(angles);
  EXPECT_NEAR(left + kNarrow_rad, 0.35, 1e-9);
  EXPECT_NEAR(right - kNarrow_rad, -0.35, 1e-9);
  // Neighbouring frames overlap by half, and the servo has half of the frame's time to get there.
  for (std::size_t i = 2; i < angles.size(); ++i)
    EXPECT_LE(std::abs(angles[i] - angles[i - 1]), std::min(kNarrow_rad, 0.5 * 3.2 * kPeriod_s) + 1e-9);
}

TEST(LookAround, SlowsTheCarToTheSweep) {
  LookAround look(PanningCar(), {});
  Angles(look, kNarrow_rad, AcrossPath(kStraightOn, 1.2, 0.24));
  const double usual_m_s = look.SpeedLimit_m_s(0.3);
  EXPECT_GT(usual_m_s, 0.3);
  EXPECT_LT(usual_m_s, 0.6);
  Angles(look, kNarrow_rad, AcrossPath(kStraightOn, 1.2, 0.24), true);
  EXPECT_LT(look.SpeedLimit_m_s(0.3), 0.6 * usual_m_s) << "lost: it looks farther around, which takes longer";
}

TEST(LookAround, LooksIntoACurve) {
  LookAround look(PanningCar(), {});
  const PathAcross to_left{Eigen::Vector2d{1.1, 0.6}, {1.0, 0.65}, {0.9, 0.7}, {0.8, 0.75}, {0.7, 0.8}};
  const std::vector<double> angles = Angles(look, kNarrow_rad, to_left);
  const auto [right, left] = std::minmax_element(angles.begin() + 50, angles.end());
  const double middle_rad = 0.5 * (std::atan2(0.6, 0.8) + std::atan2(0.8, 0.4));
  EXPECT_NEAR(0.5 * (*right + *left), middle_rad, 1e-7);  // the camera is mounted in single precision
  EXPECT_LE(*right - kNarrow_rad, std::atan2(0.6, 0.8));
  EXPECT_GE(*left + kNarrow_rad, std::atan2(0.8, 0.4));
}

TEST(LookAround, StaysWithinTheReachOfTheServo) {
  LookAround look(PanningCar(), {.half_view_lost_rad = 1.5});
  const PathAcross behind{Eigen::Vector2d{-0.5, 1.0}, {-0.5, 1.0}, {-0.5, 1.0}, {-0.5, 1.0}, {-0.5, 1.0}};
  for (const double angle_rad : Angles(look, kNarrow_rad, behind, true))
    EXPECT_LE(std::abs(angle_rad), 0.5 * std::numbers::pi + 1e-12);
}

}  // namespace
}  // namespace merlin
