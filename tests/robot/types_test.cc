// Laws of the small types every room shares.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "robot/types/config.h"
#include "robot/types/nearest_name.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"

namespace merlin {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Vector6d> Tangents() {
  std::vector<Vector6d> tangents(1, Vector6d::Zero());
  for (const double angle : {1e-12, 1e-9, 1e-5, 0.9e-4, 1.1e-4, 0.009, 0.011, 0.5, kPi - 1e-6}) {
    Vector6d tangent;
    tangent << 1.0, -2.0, 0.5, angle * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
    tangents.push_back(tangent);
  }
  return tangents;
}

TEST(Se3, LogUndoesExpFromZeroToPi) {
  for (const Vector6d& tangent : Tangents()) EXPECT_LT((Log(Exp(tangent)) - tangent).norm(), 1e-8) << tangent.transpose();
}

TEST(Se3, ExpAgreesWithEigensAngleAxisAndTheIntegralOfATwist) {
  for (const Vector6d& tangent : Tangents()) {
    const Pose pose = Exp(tangent);
    const double angle = tangent.tail<3>().norm();
    if (angle > 0.0) {
      const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, tangent.tail<3>() / angle).toRotationMatrix();
      EXPECT_LT((pose.linear() - expected).norm(), 1e-12);
    }
    // The twist driven in 20,000 straight steps ends where Exp says: error of the midpoint rule ~ angle^2 / n^2.
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) p += ExpSo3((i + 0.5) / kSteps * tangent.tail<3>()) * tangent.head<3>() / kSteps;
    EXPECT_LT((pose.translation() - p).norm(), 1e-7);
  }
}

TEST(Se3, LogOfHalfATurnHasLengthPi) {
  EXPECT_NEAR(LogSo3(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY()).toRotationMatrix()).norm(), kPi, 1e-12);
}

TEST(Se3, InterpolatesEndsAndTheMiddleOfAQuarterCircle) {
  const Pose a = FromXyYaw(1.0, 0.0, kPi / 2), b = FromXyYaw(0.0, 1.0, kPi);  // on the unit circle, counter-clockwise
  EXPECT_TRUE(Interpolate(a, b, 0.0).isApprox(a, 1e-12));
  EXPECT_TRUE(Interpolate(a, b, 1.0).isApprox(b, 1e-12));
  const Pose middle = FromXyYaw(std::sqrt(0.5), std::sqrt(0.5), 0.75 * kPi);
  EXPECT_TRUE(Interpolate(a, b, 0.5).isApprox(middle, 1e-12));
}

TEST(Angles, WrapIntoMinusPiToPi) {
  EXPECT_DOUBLE_EQ(WrapPi(0.0), 0.0);
  EXPECT_NEAR(WrapPi(3.0 * kPi / 2.0), -kPi / 2.0, 1e-15);
  EXPECT_NEAR(WrapPi(-5.0 * kPi + 0.25), -kPi + 0.25, 1e-14);
  EXPECT_NEAR(std::abs(WrapPi(kPi)), kPi, 0.0);
  EXPECT_TRUE(std::isnan(WrapPi(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Angles, YawOfATiltedPoseIsThatOfItsXAxisFromAbove) {
  for (const double yaw_rad : {-3.0, 0.0, 1e-9, 2.0}) {
    const Pose pose = FromXyYaw(1.0, 2.0, yaw_rad) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
    EXPECT_NEAR(Yaw(pose), yaw_rad, 1e-12);
  }
}

TEST(TimeType, CountsAMillionPeriodsWithoutDrift) {
  Time time{0};
  for (int i = 0; i < 1'000'000; ++i) time += FromSeconds(0.05);
  EXPECT_EQ(time, FromSeconds(50'000.0));
  EXPECT_DOUBLE_EQ(Seconds(FromSeconds(-1.5)), -1.5);
}

struct Inner {
  double a = 1.0;
};
template <class Visitor>
void Visit(Visitor& v, Inner& c) {
  v("a", c.a, {0.0, 2.0});
}
struct Outer {
  Inner inner;
  int b = 3;
  bool c = true;
  std::string d = "x";
};
template <class Visitor>
void Visit(Visitor& v, Outer& c) {
  v("inner", c.inner);
  v("b", c.b, {1.0, 5.0});
  v("c", c.c);
  v("d", c.d);
}

TEST(Config, ReportsEveryFaultWithFieldValueAndRule) {
  EXPECT_TRUE(Validate(Outer{}).empty());
  const std::vector<Fault> faults = Validate(Outer{.inner = {std::numeric_limits<double>::quiet_NaN()}, .b = 9});
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].field, "inner.a");
  EXPECT_EQ(faults[1].field, "b");
  EXPECT_EQ(faults[1].value, "9");
  EXPECT_EQ(faults[1].rule, "in [1, 5]");
}

TEST(NearestName, FindsTheNameOneSlipAway) {
  const std::set<std::string> known{"corridor_loop", "corridor_short", "hall"};
  EXPECT_EQ(NearestName("coridor_short", known), "corridor_short");
  EXPECT_EQ(NearestName("hell", known), "hall");
  EXPECT_EQ(NearestName("", known), "hall");  // fewest letters to insert
  EXPECT_EQ(NearestName("x", std::set<std::string>{}), "");
}

}  // namespace
}  // namespace merlin
