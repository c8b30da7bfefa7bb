// Laws of the small types that all modules share.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "robot/base/config.h"
#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "robot/types/camera_model.h"
#include "robot/types/color_camera.h"
#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"
#include "tests/support/thesis_ccd.h"

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
  for (const Vector6d& tangent : Tangents())
    EXPECT_LT((Log(Exp(tangent)) - tangent).norm(), 1e-8) << tangent.transpose();
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

TEST(Se3, AdjointCarriesAMotionFromAfterThePoseToBeforeIt) {
  for (const Vector6d& tangent : Tangents())
    for (const Vector6d& moved : Tangents()) {
      const Pose pose = Exp(tangent), motion = Exp(moved);
      EXPECT_LT(((pose * motion).matrix() - (Exp(Adjoint(pose) * moved) * pose).matrix()).norm(), 1e-12);
      EXPECT_LT((Adjoint(pose * motion) - Adjoint(pose) * Adjoint(motion)).norm(), 1e-12);
    }
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

const CameraModel kBarrel{.width = 640,
                          .height = 480,
                          .fx_px = 420.0,
                          .fy_px = 425.0,
                          .cx_px = 310.0,
                          .cy_px = 250.0,
                          .k1 = -0.25,
                          .k2 = 0.04,
                          .p1 = 0.004,
                          .p2 = -0.003};

// OpenCV's documentation of its calib3d module, "detailed description".
Eigen::Vector2d OpenCvPixel(const CameraModel& c, double x, double y) {
  const double r2 = x * x + y * y, radial = 1.0 + c.k1 * r2 + c.k2 * r2 * r2;
  return {c.fx_px * (x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x)) + c.cx_px,
          c.fy_px * (y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y) + c.cy_px};
}

TEST(CameraModel, ProjectsAsOpenCvsFormula) {
  for (const CameraModel& camera : {kThesisCcd, kBarrel})
    for (const double x : {-0.4, -1e-9, 0.0, 0.2})
      for (const double y : {-0.25, 0.0, 1e-9, 0.3})
        EXPECT_LT((camera.Project(3.0 * Eigen::Vector3d(x, y, 1.0)) - OpenCvPixel(camera, x, y)).norm(), 1e-9)
            << x << " " << y;
}

TEST(CameraModel, RaysInvertTheDistortionFromTheCentreToTheCorners) {
  for (const CameraModel& camera : {kThesisCcd, kBarrel}) {
    EXPECT_TRUE(camera.IsInvertible());
    for (const double u : {-0.5, 0.0, 200.25, camera.cx_px, 639.0, 639.5})
      for (const double v : {-0.5, 0.0, camera.cy_px, 300.5, 479.0, 479.5}) {
        const Eigen::Vector3d ray = camera.Ray(u, v);
        EXPECT_NEAR(ray.norm(), 1.0, 1e-15);
        const Eigen::Vector2d pixel = OpenCvPixel(camera, ray.x() / ray.z(), ray.y() / ray.z());
        EXPECT_LT((pixel - Eigen::Vector2d(u, v)).norm(), 1e-8) << u << " " << v;  // 1e-10 of a slope, and less
        EXPECT_LT((camera.Project(5.0 * ray) - Eigen::Vector2d(u, v)).norm(), 1e-8) << u << " " << v;
      }
  }
  EXPECT_EQ(kThesisCcd.Ray(kThesisCcd.cx_px, kThesisCcd.cy_px), Eigen::Vector3d::UnitZ());
}

TEST(CameraModel, WithoutDistortionIsThePinhole) {
  CameraModel pinhole = kThesisCcd;
  pinhole.k1 = pinhole.k2 = pinhole.p1 = pinhole.p2 = 0.0;
  EXPECT_TRUE(pinhole.IsInvertible());
  const Eigen::Vector3d by_hand((13.0 - 353.244) / 780.037, (400.0 - 223.784) / 777.844, 1.0);
  EXPECT_EQ(pinhole.Ray(13.0, 400.0), by_hand.normalized());
  EXPECT_LT((pinhole.Project(by_hand) - Eigen::Vector2d(13.0, 400.0)).norm(), 1e-9);
  EXPECT_EQ(pinhole.Undistort({9.0, -9.0}), Eigen::Vector2d(9.0, -9.0));
}

// x (1 - x^2 / 2) rises to 0.5443 at x = 0.8165 and falls from there: at x = 1 it is 0.5 again, as at x = 0.618.
TEST(CameraModel, GivesNothingBeyondTheAngleWhereTheLensFoldsOver) {
  CameraModel camera{
      .width = 200, .height = 200, .fx_px = 200.0, .fy_px = 200.0, .cx_px = 99.5, .cy_px = 99.5, .k1 = -0.5};
  EXPECT_NEAR(camera.Undistort({0.5, 0.0}).x(), (std::sqrt(5.0) - 1.0) / 2.0, 1e-12);
  EXPECT_TRUE(camera.Undistort({0.56, 0.0}).hasNaN());
  EXPECT_TRUE(camera.Project({1.0, 0.0, 1.0}).hasNaN());
  EXPECT_FALSE(camera.Project({0.61, 0.0, 1.0}).hasNaN());
  EXPECT_TRUE(camera.Project({std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0}).hasNaN());
}

TEST(CameraModel, KnowsWhetherTheFoldLiesInThePicture) {
  // Half the diagonal over the focal length against the fold at 0.5443.
  for (const auto& [focal_px, invertible] : {std::pair(500.0, true), {262.0, true}, {258.0, false}, {100.0, false}}) {
    CameraModel camera{
        .width = 200, .height = 200, .fx_px = focal_px, .fy_px = focal_px, .cx_px = 99.5, .cy_px = 99.5, .k1 = -0.5};
    EXPECT_EQ(camera.IsInvertible(), invertible) << focal_px;
  }
}

TEST(ColorSettings, AreRefusedOutsideTheSheet) {
  const ColorCameraSheet sheet{
      .name = "x", .exposure_nominal_s = 0.01, .exposure_min_s = 0.001, .exposure_max_s = 0.02, .gain_max = 4.0};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(CheckSettings(sheet, DefaultSettings(sheet)));
  EXPECT_NO_THROW(
      CheckSettings(sheet, {.exposure_s = 0.02, .gain = 4.0, .white_balance_red = 4.0, .white_balance_blue = 0.25}));
  for (const double exposure_s : {0.0, 0.00099, 0.0201, nan})
    EXPECT_THROW(CheckSettings(sheet, {.exposure_s = exposure_s}), InputError);
  for (const double gain : {0.99, 4.01, nan})
    EXPECT_THROW(CheckSettings(sheet, {.exposure_s = 0.01, .gain = gain}), InputError);
  EXPECT_THROW(CheckSettings(sheet, {.exposure_s = 0.01, .white_balance_red = 0.2}), InputError);
  EXPECT_THROW(CheckSettings(sheet, {.exposure_s = 0.01, .white_balance_blue = nan}), InputError);
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

DepthCameraSheet Sheet() {
  DepthCameraSheet sheet;
  sheet.name = "tof";
  sheet.readout_s = 1e-3;
  sheet.integration_min_s = 100e-6;
  sheet.integration_max_s = 5000e-6;
  sheet.frequencies_hz = {20e6, 30e6};
  return sheet;
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What CheckSettings says; empty: valid.
std::string Complaint(const DepthSettings& settings) {
  try {
    CheckSettings(Sheet(), settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(DepthSettingsType, UnambiguousRangeIsHalfTheWavelength) {
  EXPECT_NEAR(UnambiguousRange_m(DepthSettings{.frequency_hz = 20e6}), 7.495, 0.0005);
  EXPECT_NEAR(UnambiguousRange_m(DepthSettings{.frequency_hz = 30e6}), 4.997, 0.0005);
  EXPECT_NEAR(UnambiguousRange_m(DepthSettings{.frequency_hz = 3.75e6}), 39.972, 0.0005);
}

// Both phases repeat first at the smallest common multiple of the two ranges.
TEST(DepthSettingsType, TwoFrequenciesWrapWhereBothDo) {
  const auto both_m = [](double a_hz, double b_hz) {
    return UnambiguousRange_m(DepthSettings{.frequency_hz = a_hz, .second_frequency_hz = b_hz});
  };
  EXPECT_NEAR(both_m(20e6, 30e6), 14.990, 0.0005);  // 2 x 7.495 = 3 x 4.997
  EXPECT_EQ(both_m(20e6, 30e6), both_m(30e6, 20e6));
  EXPECT_NEAR(both_m(18e6, 21e6), 6.0 * 8.3276, 0.001);
  EXPECT_NEAR(both_m(20e6, 21e6), 149.896, 0.001);
  EXPECT_NEAR(both_m(3.75e6, 20e6), 119.917, 0.001);
}

TEST(DepthSettingsType, ExposureSpansItsSubFramesAndTheReadOutsBetween) {
  EXPECT_EQ(DepthSettings{}.sub_frames(), 4);
  EXPECT_NEAR(Sheet().ExposureSpan_s({.integration_s = 2e-3}), 11e-3, 1e-15);
  const DepthSettings two{.integration_s = 2e-3, .second_frequency_hz = 30e6};
  EXPECT_EQ(two.sub_frames(), 8);
  EXPECT_NEAR(Sheet().ExposureSpan_s(two), 23e-3, 1e-15);
}

TEST(DepthSettingsType, ValidOnesReachFromTheShortestToTheLongest) {
  for (const double integration_s : {100e-6, 101e-6, 1e-3, 5000e-6})
    EXPECT_EQ(Complaint({.integration_s = integration_s}), "") << integration_s;
  EXPECT_EQ(Complaint({.frequency_hz = 30e6, .second_frequency_hz = 20e6}), "");
  for (const double integration_s : {99.9e-6, 5000.1e-6, 0.0, -1e-3, kNaN, kInfinity}) {
    const std::string said = Complaint({.integration_s = integration_s});
    EXPECT_NE(said.find("tof: invalid integration time; expected 100 to 5000 us, got "), std::string::npos) << said;
  }
}

TEST(DepthSettingsType, OnlyListedFrequenciesAreValid) {
  for (const double frequency_hz : {19e6, 0.0, -20e6, kNaN, kInfinity}) {
    const std::string said = Complaint({.frequency_hz = frequency_hz});
    EXPECT_NE(said.find("tof: invalid modulation frequency; expected 20 or 30 MHz, got "), std::string::npos) << said;
  }
  for (const double second_hz : {25e6, -30e6, kNaN}) EXPECT_NE(Complaint({.second_frequency_hz = second_hz}), "");
  EXPECT_NE(Complaint({.frequency_hz = 30e6, .second_frequency_hz = 30e6}).find("30 MHz twice"), std::string::npos);
}

TEST(DepthSettingsType, NearestAreTheClosestValidOnes) {
  const DepthSettings given{.integration_s = 7e-3, .frequency_hz = 24e6, .post_processing = true};
  const DepthSettings nearest = NearestSettings(Sheet(), given);
  EXPECT_EQ(nearest.integration_s, 5000e-6);
  EXPECT_EQ(nearest.frequency_hz, 20e6);
  EXPECT_EQ(nearest.second_frequency_hz, 0.0);
  EXPECT_TRUE(nearest.post_processing);
  EXPECT_EQ(NearestSettings(Sheet(), {.integration_s = -1.0}).integration_s, 100e-6);
  EXPECT_EQ(NearestSettings(Sheet(), {.frequency_hz = 26e6}).frequency_hz, 30e6);
  EXPECT_EQ(NearestSettings(Sheet(), {.second_frequency_hz = 99e6}).second_frequency_hz, 30e6);
}

TEST(DepthSettingsType, ValidOnesAreTheirOwnNearest) {
  const DepthSettings given{.integration_s = 123e-6, .frequency_hz = 30e6, .second_frequency_hz = 20e6};
  const DepthSettings nearest = NearestSettings(Sheet(), given);
  EXPECT_EQ(nearest.integration_s, given.integration_s);
  EXPECT_EQ(nearest.frequency_hz, given.frequency_hz);
  EXPECT_EQ(nearest.second_frequency_hz, given.second_frequency_hz);
}

TEST(DepthSettingsType, NothingIsNearToNoNumber) {
  EXPECT_THROW(NearestSettings(Sheet(), {.integration_s = kNaN}), InputError);
  EXPECT_THROW(NearestSettings(Sheet(), {.integration_s = kInfinity}), InputError);
  EXPECT_THROW(NearestSettings(Sheet(), {.frequency_hz = kNaN}), InputError);
  EXPECT_THROW(NearestSettings(Sheet(), {.second_frequency_hz = kNaN}), InputError);
}

TEST(DepthCameraErrorsType, DefaultsAreWithinTheirRanges) { EXPECT_TRUE(Validate(DepthCameraErrors{}).empty()); }

}  // namespace
}  // namespace merlin
