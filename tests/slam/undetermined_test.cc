#include "slam/register/undetermined.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace merlin {
namespace {

// Points of planes: centre, normal; 2 m wide each way.
struct Plane {
  Eigen::Vector3d centre, normal;
};

PairSums SumsOf(const std::vector<Plane>& planes, const Eigen::Vector3d& shift) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-1.0, 1.0);
  PairSums sums;
  for (const Plane& plane : planes)
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d u = plane.normal.unitOrthogonal();
      const Eigen::Vector3d p = plane.centre + at(random) * u + at(random) * plane.normal.cross(u) + shift;
      Eigen::Matrix<double, 3, 6> J;
      J << Eigen::Matrix3d::Identity(), -Hat(p);
      sums.information += J.transpose() * plane.normal * plane.normal.transpose() * J;
      sums.whole += J.transpose() * J;
    }
  return sums;
}

Undetermined Of(const std::vector<Plane>& planes, const Eigen::Vector3d& shift = {0, 0, 0}) {
  return FindUndetermined(SplitIntoShares(SumsOf(planes, shift)));
}

bool Contains(const Undetermined& undetermined, const Vector6d& motion) {
  const Eigen::MatrixXd basis = undetermined.directions;
  const Vector6d rest = motion - basis * basis.colPivHouseholderQr().solve(motion);
  return rest.norm() < 1e-6 * motion.norm();
}

Vector6d Twist(double x, double y, double z, double roll, double pitch, double yaw) {
  return (Vector6d() << x, y, z, roll, pitch, yaw).finished();
}

const Plane kFloor{{0, 0, 0}, {0, 0, 1}}, kLeft{{0, 1, 1}, {0, 1, 0}}, kRight{{0, -1, 1}, {0, 1, 0}},
    kEnd{{1, 0, 1}, {1, 0, 0}};

TEST(Undetermined, IsNothingInACornerOfThreeWalls) { EXPECT_EQ(Of({kFloor, kLeft, kEnd}).count(), 0); }

TEST(Undetermined, IsTheAxisOfABareCorridor) {
  const Undetermined undetermined = Of({kFloor, kLeft, kRight});
  ASSERT_EQ(undetermined.count(), 1);
  EXPECT_TRUE(Contains(undetermined, Twist(1, 0, 0, 0, 0, 0)));
}

TEST(Undetermined, IsSlidingAndTurningOnABareFloor) {
  const Undetermined undetermined = Of({kFloor});
  ASSERT_EQ(undetermined.count(), 3);
  EXPECT_TRUE(Contains(undetermined, Twist(1, 0, 0, 0, 0, 0)));
  EXPECT_TRUE(Contains(undetermined, Twist(0, 1, 0, 0, 0, 0)));
  EXPECT_TRUE(Contains(undetermined, Twist(0, 0, 0, 0, 0, 1)));
}

TEST(Undetermined, HasTheSameSharesFromAnyOriginInAnyUnit) {
  const auto near = SplitIntoShares(SumsOf({kFloor, kLeft, kRight}, {0, 0, 0}));
  const auto far = SplitIntoShares(SumsOf({kFloor, kLeft, kRight}, {30, -20, 10}));
  EXPECT_LT((near.shares - far.shares).norm(), 1e-6);
  // From there a turn of the floor about its own middle is a turn and a shift.
  EXPECT_TRUE(Contains(Of({kFloor}, {30, -20, 10}), Twist(-20, -30, 0, 0, 0, 1)));
  const Matrix6d millimetres = (Vector6d() << 1e3, 1e3, 1e3, 1, 1, 1).finished().asDiagonal();
  PairSums sums = SumsOf({kFloor, kLeft, kRight}, {0, 0, 0});
  sums = {.information = millimetres * sums.information * millimetres, .whole = millimetres * sums.whole * millimetres};
  EXPECT_LT((SplitIntoShares(sums).shares - near.shares).norm(), 1e-6);
}

TEST(Undetermined, IsTheTurnOfALineAboutItself) {
  PairSums sums;
  for (int i = -5; i <= 5; ++i) {
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -Hat(Eigen::Vector3d(i, i, 0.0));
    sums.information += J.transpose() * J;
    sums.whole += 3.0 * J.transpose() * J;
  }
  const Undetermined undetermined = FindUndetermined(SplitIntoShares(sums));
  ASSERT_EQ(undetermined.count(), 1);
  EXPECT_TRUE(Contains(undetermined, Twist(0, 0, 0, 1, 1, 0)));
}

TEST(Undetermined, IsEverythingWithoutPairsOrWithNumbersThatAreNone) {
  EXPECT_EQ(FindUndetermined(SplitIntoShares({})).count(), 6);
  EXPECT_EQ(FindUndetermined(
                SplitIntoShares({.information = Matrix6d::Constant(std::nan("")), .whole = Matrix6d::Identity()}))
                .count(),
            6);
  EXPECT_EQ(FindUndetermined(SplitIntoShares({.information = Matrix6d::Zero(), .whole = Matrix6d::Identity()})).count(),
            6);
}

TEST(StepWhereHeld, IsNewtonsStepWithoutWhatIsNotHeld) {
  const Vector6d gradient = Twist(1, 2, 3, -1, 0.5, 0.2);
  const PairSums corner = SumsOf({kFloor, kLeft, kEnd}, {0, 0, 0});
  const Vector6d newton = -corner.information.ldlt().solve(gradient);
  EXPECT_LT((StepWhereHeld(SplitIntoShares(corner), gradient) - newton).norm(), 1e-9 * newton.norm());
  // In a corridor the points on the whole do not move along it.
  const PairSums corridor = SumsOf({kFloor, kLeft, kRight}, {0, 0, 0});
  const Vector6d step = StepWhereHeld(SplitIntoShares(corridor), gradient);
  EXPECT_NEAR((corridor.whole * step)(0), 0.0, 1e-6 * corridor.whole(0, 0) * step.norm());
  EXPECT_TRUE(StepWhereHeld({}, gradient).isZero());
}

}  // namespace
}  // namespace merlin
