#include "sim/actors/timed_path.h"

#include <gtest/gtest.h>

#include <numbers>

namespace merlin::sim {
namespace {

constexpr double kPi = std::numbers::pi;

void ExpectAt(const TimedPath& path, double t_s, const Eigen::Vector3d& position_m, const Eigen::Vector3d& velocity_m_s,
              double yaw_rad) {
  const BodyMotion motion = path.At(t_s);
  EXPECT_LT((motion.T_world_body.translation() - position_m).norm(), 1e-12) << t_s;
  EXPECT_LT((motion.velocity_m_s - velocity_m_s).norm(), 1e-12) << t_s;
  EXPECT_NEAR(std::remainder(Yaw(motion.T_world_body) - yaw_rad, 2 * kPi), 0.0, 1e-12) << t_s;
}

// Two metres along x in four seconds, a rest of one second, then three metres along -y in one.
TEST(TimedPath, GoesEvenlyBetweenItsPointsAndFacesWhereItGoes) {
  const TimedPath path({{2, 1, 5}, {6, 3, 5}, {7, 3, 5}, {8, 3, 2}});
  ExpectAt(path, 0.0, {1, 5, 0}, {0, 0, 0}, 0.0);
  ExpectAt(path, 2.0, {1, 5, 0}, {0.5, 0, 0}, 0.0);
  ExpectAt(path, 3.0, {1.5, 5, 0}, {0.5, 0, 0}, 0.0);
  ExpectAt(path, 6.5, {3, 5, 0}, {0, 0, 0}, 0.0);  // at rest, with the last yaw
  ExpectAt(path, 7.5, {3, 3.5, 0}, {0, -3, 0}, -kPi / 2);
  ExpectAt(path, 8.0, {3, 2, 0}, {0, 0, 0}, -kPi / 2);
  ExpectAt(path, 1e6, {3, 2, 0}, {0, 0, 0}, -kPi / 2);
}

TEST(TimedPath, StandsWhereItHasOnePointOnly) {
  const TimedPath path({{0, 1, 2}});
  for (const double t_s : {0.0, 1e-9, 5.0}) ExpectAt(path, t_s, {1, 2, 0}, {0, 0, 0}, 0.0);
  EXPECT_EQ(path.begin_s(), 0.0);
}

TEST(TimedPath, FacesTheFirstLegThatHasADirection) {
  ExpectAt(TimedPath({{0, 0, 0}, {1, 0, 0}, {2, 0, 1}}), 0.5, {0, 0, 0}, {0, 0, 0}, kPi / 2);
}

TEST(TimedPath, TurnsAndRisesAsItsPointsSay) {
  const TimedPath path({{0, 1, 0, 0, 0.5}, {2, 1, 0, 4 * kPi, 1.5}});  // two whole turns
  ExpectAt(path, 0.25, {1, 0, 0.625}, {0, 0, 0.5}, kPi / 2);
  EXPECT_LT((path.At(0.25).angular_velocity_rad_s - Eigen::Vector3d(0, 0, 2 * kPi)).norm(), 1e-12);
  EXPECT_TRUE(path.At(2.0).still());
}

// The velocity is the position's derivative.
TEST(TimedPath, MovesAsItsVelocitySays) {
  const TimedPath path({{0, 0, 0, 0.1, 0}, {3, 2, -1, 1.3, 0.2}});
  const BodyMotion now = path.At(1.0);
  const Pose later = path.At(1.01).T_world_body, foreseen = now.At(0.01);
  EXPECT_LT((later.translation() - foreseen.translation()).norm(), 1e-12);
  EXPECT_LT((later.linear() - foreseen.linear()).norm(), 1e-12);
}

}  // namespace
}  // namespace merlin::sim
