#include "slam/graph/edge_error.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/random_graph.h"

namespace merlin {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

// Derivatives by central differences: of the error by a step of one end.
template <class Group>
typename Group::Matrix Differences(const Pose& from, const Pose& to, const Pose& measured, bool by_from,
                                   PlanarRotation rotation) {
  constexpr double kStep = 1e-6;
  typename Group::Matrix J;
  for (int i = 0; i < Group::kSize; ++i) {
    const auto error = [&](double h) {
      const typename Group::Vector step = h * Group::Vector::Unit(i);
      const auto a = Group::Of(from), b = Group::Of(to);
      return Group::Error(by_from ? Group::Moved(a, step) : a, by_from ? b : Group::Moved(b, step), Group::Of(measured),
                          rotation);
    };
    J.col(i) = (error(kStep) - error(-kStep)) / (2.0 * kStep);
  }
  return J;
}

template <class Group>
void ExpectDerivatives(const Pose& from, const Pose& to, const Pose& measured, PlanarRotation rotation) {
  const auto linear = Group::Linearize(Group::Of(from), Group::Of(to), Group::Of(measured), rotation);
  EXPECT_TRUE(linear.error == Group::Error(Group::Of(from), Group::Of(to), Group::Of(measured), rotation));
  EXPECT_LT((linear.J_to - Differences<Group>(from, to, measured, false, rotation)).norm(), 1e-7);
  EXPECT_LT((-linear.J_to * linear.adjoint - Differences<Group>(from, to, measured, true, rotation)).norm(), 1e-6);
}

// Errors of rotation from zero to just short of a turn of pi, where the sign of the error flips.
const double kAngles[] = {0.0, 1e-12, 1e-6, 0.1, 1.0, 3.0, kHalfTurn - 1e-3, -kHalfTurn + 1e-3};

TEST(EdgeError, HasTheDerivativesThatDifferencesFindInSpace) {
  RandomGraphs random(1);
  for (const double angle_rad : kAngles)
    for (int i = 0; i < 5; ++i) {
      const Pose from = Exp(random.Tangent(3.0, 1.5)), measured = Exp(random.Tangent(2.0, 1.0));
      const Eigen::Vector3d axis = random.Tangent(1.0, 1.0).tail<3>().normalized();
      const Pose off = Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(angle_rad, axis);
      ExpectDerivatives<Spatial>(from, from * measured * off, measured, PlanarRotation::kAngle);
    }
}

TEST(EdgeError, HasTheDerivativesThatDifferencesFindInThePlane) {
  RandomGraphs random(2);
  for (const double angle_rad : kAngles)
    for (const PlanarRotation rotation : {PlanarRotation::kAngle, PlanarRotation::kChord}) {
      const Pose from = FromXyYaw(random.Normal(3.0), random.Normal(3.0), random.Normal(2.0));
      const Pose measured = FromXyYaw(random.Normal(), random.Normal(), random.Normal());
      ExpectDerivatives<Planar>(from, from * measured * FromXyYaw(0.2, -0.1, angle_rad), measured, rotation);
    }
}

TEST(EdgeError, IsThatOfTheMatrices) {
  RandomGraphs random(3);
  for (int i = 0; i < 20; ++i) {
    const Pose from = Exp(random.Tangent(3.0, 1.5)), to = Exp(random.Tangent(3.0, 1.5)),
               measured = Exp(random.Tangent(1.0, 1.0));
    const Pose E = measured.inverse() * from.inverse() * to;
    const Vector6d error =
        Spatial::Error(Spatial::Of(from), Spatial::Of(to), Spatial::Of(measured), PlanarRotation::kAngle);
    EXPECT_LT((error.head<3>() - E.translation()).norm(), 1e-12);
    const Eigen::Vector3d w = LogSo3(E.linear());
    EXPECT_LT((error.tail<3>() - 2.0 * std::sin(0.5 * w.norm()) * w.normalized()).norm(), 1e-12);
  }
}

TEST(EdgeError, WrapsTheAngle) {
  const auto pose = [](double yaw_rad) { return Planar::Of(FromXyYaw(0.0, 0.0, yaw_rad)); };
  const Eigen::Vector3d error = Planar::Error(pose(3.1), pose(-3.1), pose(0.0), PlanarRotation::kAngle);
  EXPECT_NEAR(error.z(), 2.0 * kHalfTurn - 6.2, 1e-14);
  const Pose half_turn(Eigen::AngleAxisd(kHalfTurn, Eigen::Vector3d::UnitX()));
  const Vector6d spatial =
      Spatial::Error(Spatial::Of(Pose::Identity()), Spatial::Of(half_turn), Spatial::Of(Pose::Identity()), {});
  EXPECT_NEAR(spatial.tail<3>().norm(), 2.0, 1e-14);
}

TEST(EdgeError, MovesAsTheExponentialToFirstOrderAndStaysARotation) {
  RandomGraphs random(4);
  for (const double size : {0.0, 1e-9, 1e-5, 3.0}) {
    const Pose pose = Exp(random.Tangent(2.0, 1.0));
    const Vector6d step = size * random.Tangent(1.0, 1.0);
    const Spatial::State moved = Spatial::Moved(Spatial::Of(pose), step);
    EXPECT_NEAR(moved.q.norm(), 1.0, 1e-15);
    EXPECT_LT((Spatial::ToPose(moved).linear() - pose.linear() * ExpSo3(step.tail<3>())).norm(), 1e-14);
    EXPECT_LT((moved.t_m - (pose * Exp(step)).translation()).norm(), 10.0 * size * size + 1e-14);
  }
}

}  // namespace
}  // namespace merlin
