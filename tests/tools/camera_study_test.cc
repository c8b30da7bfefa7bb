// The parts of `merlin camera` that need no camera: array files, statistics of ranges that wrap, axes, and which body a
// point lies in.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "robot/base/error.h"
#include "robot/base/random.h"
#include "sim/world/room.h"
#include "tests/support/temporary_folder.h"
#include "tools/camera/figure.h"
#include "tools/camera/inside.h"
#include "tools/camera/npy.h"
#include "tools/camera/scale.h"
#include "tools/camera/stage.h"
#include "tools/camera/statistics.h"
#include "tools/camera/study.h"

namespace merlin {
namespace {

// The format as numpy.lib.format specifies it, read by hand.
TEST(Npy, HasTheHeaderThatNumpySpecifies) {
  const std::vector<float> values{1.5f, -2.0f, 0.0f, 3.0f, 4.0f, 1e-20f};
  const std::string bytes = ToNpy(values, {2, 3});
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length = static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  const std::string header = bytes.substr(10, length);
  EXPECT_EQ(header.find("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, ), }"), 0u) << header;
  EXPECT_EQ(header.back(), '\n');
  ASSERT_EQ(bytes.size(), 10 + length + 24);
  EXPECT_EQ(std::memcmp(bytes.data() + 10 + length, values.data(), 24), 0);
}

TEST(Npy, NamesEachTypeAndKeepsTheDataAlignedForAnyShape) {
  for (std::size_t dimensions = 1; dimensions < 40; ++dimensions) {
    const std::vector<std::uint8_t> one{7};
    const std::string bytes = ToNpy(one, std::vector<std::size_t>(dimensions, 1));
    EXPECT_EQ((bytes.size() - 1) % 64, 0u) << dimensions;
    EXPECT_EQ(bytes.back(), 7);
  }
  EXPECT_NE(ToNpy(std::vector<double>{1.0}, {1}).find("'<f8'"), std::string::npos);
  EXPECT_NE(ToNpy(std::vector<std::int32_t>{1}, {1}).find("'<i4'"), std::string::npos);
  EXPECT_NE(ToNpy(std::vector<std::uint8_t>{1}, {1}).find("'|u1'"), std::string::npos);
  EXPECT_NE(ToNpy(std::vector<float>{}, {0, 4}).find("(0, 4, )"), std::string::npos);
}

TEST(UnwrapNear, StaysWithinHalfAPeriodOfTheReference) {
  EXPECT_NEAR(UnwrapNear(7.4, 0.1, 7.5), -0.1, 1e-12);
  EXPECT_NEAR(UnwrapNear(0.1, 7.4, 7.5), 7.6, 1e-12);
  EXPECT_NEAR(UnwrapNear(1.505, 9.0, 7.495), 9.0, 1e-12);
  EXPECT_EQ(UnwrapNear(3.0, 3.0, 7.5), 3.0);
  EXPECT_TRUE(std::isnan(UnwrapNear(std::nan(""), 1.0, 7.5)));
}

TEST(Pool, IsTheTextbookMeanAndPooledSigma) {
  std::vector<PixelSamples> pixels(3);
  for (const double range_m : {1.0, 2.0, 3.0}) pixels[0].Add(range_m);  // mean 2, squares 2
  for (const double range_m : {10.0, 14.0}) pixels[1].Add(range_m);     // mean 12, squares 8; pixel 2 saw nothing
  const RangeStatistics pooled = Pool(pixels);
  EXPECT_EQ(pooled.samples, 5u);
  EXPECT_NEAR(*pooled.mean_m, 30.0 / 5.0, 1e-12);
  EXPECT_NEAR(*pooled.sigma_m, std::sqrt((2.0 + 8.0) / (2.0 + 1.0)), 1e-12);
}

TEST(Pool, KnowsWhatItDoesNotKnow) {
  EXPECT_FALSE(Pool({}).mean_m.has_value());
  std::vector<PixelSamples> pixels(2);
  EXPECT_FALSE(Pool(pixels).mean_m.has_value());
  pixels[0].Add(1.0);
  pixels[1].Add(2.0);  // one sample a pixel says nothing about time
  EXPECT_NEAR(*Pool(pixels).mean_m, 1.5, 1e-12);
  EXPECT_FALSE(Pool(pixels).sigma_m.has_value());
}

TEST(Pool, FindsTheSigmaThatTheNoiseHasWhateverThePixelsMeans) {
  constexpr double kSigma_m = 0.02;
  constexpr int kPixels = 200, kFrames = 50;
  std::vector<PixelSamples> pixels(kPixels);
  for (int p = 0; p < kPixels; ++p)
    for (int i = 0; i < kFrames; ++i) {
      Random random(3, Sensor::kDepth, static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(p));
      pixels[static_cast<std::size_t>(p)].Add(1.0 + 0.1 * p + kSigma_m * random.Normal());
    }
  // The sample sigma of n samples scatters by sigma / sqrt(2 n): three of them.
  EXPECT_NEAR(*Pool(pixels).sigma_m, kSigma_m, 3.0 * kSigma_m / std::sqrt(2.0 * kPixels * (kFrames - 1)));
}

TEST(Median, TakesTheMiddle) {
  EXPECT_EQ(Median({3.0}), 3.0);
  EXPECT_EQ(Median({9.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median({4.0, 1.0, 2.0, 9.0}), 3.0);
}

TEST(ScaleFor, CoversTheValuesWithRoundTicks) {
  const std::vector<double> values{-3.2, 47.7, std::nan("")};
  const Scale scale = ScaleFor(values, {});
  EXPECT_EQ(scale.low, -10.0);
  EXPECT_EQ(scale.high, 50.0);
  ASSERT_EQ(scale.ticks.size(), 7u);
  EXPECT_EQ(scale.ticks[1].text, "0");
  EXPECT_NEAR(scale.Share(20.0), 0.5, 1e-12);
}

TEST(ScaleFor, HasALengthForOneValueAndForNone) {
  for (const std::vector<double>& values : {std::vector<double>{}, {0.0}, {5.0}, {-2.0, -2.0}, {std::nan("")}}) {
    for (const bool logarithmic : {false, true}) {
      const Scale scale = ScaleFor(values, {.logarithmic = logarithmic});
      EXPECT_LT(scale.low, scale.high);
      EXPECT_GE(scale.ticks.size(), 2u);
    }
  }
}

TEST(ScaleFor, LeavesOutOfALogarithmicAxisWhatIsNotPositive) {
  const std::vector<double> values{0.0, -1.0, 0.3, 40.0};
  const Scale scale = ScaleFor(values, {.logarithmic = true});
  EXPECT_NEAR(scale.low, 0.2, 1e-12);
  EXPECT_NEAR(scale.high, 50.0, 1e-9);
  EXPECT_NEAR(scale.Share(std::sqrt(0.2 * 50.0)), 0.5, 1e-12);
  for (const Tick& tick : scale.ticks) EXPECT_TRUE(tick.value >= scale.low && tick.value <= scale.high) << tick.text;
}

TEST(FigureCsv, HoldsEveryPointOfEverySeries) {
  const Figure figure{"t",
                      "s",
                      {{.x = {"x [m]"},
                        .y = {"y [mm]"},
                        .series = {{.name = "law", .x = {1.0, 2.0}, .y = {3.0, 4.0}},
                                   {.name = "dots", .dots = true, .x = {1.0}, .y = {3.5}}}}}};
  const std::string csv = ToCsv(figure);
  EXPECT_NE(csv.find("0,\"law\",law,1,3\n0,\"law\",law,2,4\n0,\"dots\",samples,1,3.5\n"), std::string::npos) << csv;
  EXPECT_EQ(ToPng(figure).substr(1, 3), "PNG");
}

// A world with one geom of each type, 10 m apart, rotated.
class InsideTest : public testing::Test {
 protected:
  InsideTest() {
    sim::SilenceMujoco();
    char error[500] = "";
    // The mesh: a tetrahedron with its corner at the origin of its geom; MuJoCo moves a mesh to its middle and back.
    const std::string mjcf = R"(<mujoco><asset><mesh name="m" vertex="0 0 0  2 0 0  0 2 0  0 0 2"/></asset><worldbody>
      <geom name="floor" type="plane" size="0 0 1" pos="0 0 -5"/>
      <geom name="box" type="box" size="1 .1 .5" euler="0 0 45"/>
      <geom name="ball" type="sphere" size=".5" pos="10 0 0"/>
      <geom name="bar" type="capsule" size=".2 1" pos="20 0 0" euler="0 90 0"/>
      <geom name="tin" type="cylinder" size=".5 1" pos="30 0 0"/>
      <geom name="egg" type="ellipsoid" size="1 .5 .25" pos="40 0 0"/>
      <geom name="roof" type="mesh" mesh="m" pos="50 0 0"/>
      <geom name="ghost" type="box" size="1 1 1" pos="60 0 0" rgba="1 1 1 0"/>
    </worldbody></mujoco>)";
    const sim::SpecPtr spec(mj_parseXMLString(mjcf.c_str(), nullptr, error, sizeof error), mj_deleteSpec);
    model_.reset(mj_compile(spec.get(), nullptr));
    data_.reset(mj_makeData(model_.get()));
    mj_kinematics(model_.get(), data_.get());
  }

  std::string Around(double x, double y, double z) const {
    return GeomAround(model_.get(), data_.get(), {x, y, z}).value_or("free");
  }

  std::unique_ptr<mjModel, void (*)(mjModel*)> model_{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data_{nullptr, mj_deleteData};
};

TEST_F(InsideTest, NamesTheGeomOfEachShape) {
  EXPECT_EQ(Around(0.6, 0.6, 0.0), "box");  // along its turned long edge
  EXPECT_EQ(Around(0.6, -0.6, 0.0), "free");
  EXPECT_EQ(Around(10.4, 0.0, 0.2), "ball");
  EXPECT_EQ(Around(10.4, 0.4, 0.0), "free");
  EXPECT_EQ(Around(21.1, 0.0, 0.0), "bar");  // in its cap
  EXPECT_EQ(Around(21.1, 0.0, 0.19), "free");
  EXPECT_EQ(Around(30.3, 0.3, 0.9), "tin");
  EXPECT_EQ(Around(30.4, 0.4, 0.0), "free");
  EXPECT_EQ(Around(40.0, 0.0, 0.24), "egg");
  EXPECT_EQ(Around(40.9, 0.0, 0.24), "free");
}

TEST_F(InsideTest, CountsTheTrianglesOfAMesh) {
  // The tetrahedron x, y, z > 0, x + y + z < 2.
  EXPECT_EQ(Around(50.3, 0.3, 0.3), "roof");
  EXPECT_EQ(Around(50.6, 0.6, 0.6), "roof");
  EXPECT_EQ(Around(50.8, 0.8, 0.8), "free");
  EXPECT_EQ(Around(49.9, 0.3, 0.3), "free");
  EXPECT_EQ(Around(50.3, 0.3, -0.1), "free");
}

TEST_F(InsideTest, FindsMatterBelowAPlaneAndNoneInWhatCannotBeSeen) {
  EXPECT_EQ(Around(5.0, 5.0, -5.1), "floor");
  EXPECT_EQ(Around(5.0, 5.0, -4.9), "free");
  EXPECT_EQ(Around(60.0, 0.0, 0.0), "free");
}

TEST(WallStage, PutsTheSurfaceSquarelyOnTheAxis) {
  for (const double tilt_deg : {0.0, 30.0, -60.0}) {
    const double tilt_rad = tilt_deg * std::numbers::pi / 180.0;
    const Stage stage = WallStage({.distance_m = 3.0, .tilt_rad = tilt_rad});
    const Eigen::Vector3d left = Eigen::Vector3d(1.0, 0.2, 0.1).normalized();
    const std::vector<sim::Ray> rays{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, left.cast<float>()}};
    std::vector<sim::RayHit> hits(2);
    stage.scene->Cast(rays, hits);
    EXPECT_NEAR(hits[0].range_m, 3.0, 1e-4) << tilt_deg;
    EXPECT_NEAR(-hits[0].normal.x(), std::cos(tilt_rad), 1e-5) << tilt_deg;
    // The plane through (3, 0, 0) with that normal.
    const Eigen::Vector3d normal(std::cos(tilt_rad), std::sin(tilt_rad), 0.0);
    EXPECT_NEAR(hits[1].range_m, 3.0 * normal.x() / normal.dot(left), 1e-4) << tilt_deg;
  }
}

TEST(BodyOptical, LooksAlongBodyXWithItsRightAtMinusY) {
  EXPECT_TRUE((BodyOptical() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE((BodyOptical() * Eigen::Vector3d::UnitX()).isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_TRUE((BodyOptical() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST(StudyNames, AreNineAndUnknownOnesAreRefusedWithTheNearest) {
  EXPECT_EQ(StudyNames().size(), 9u);
  try {
    CheckStudyName("wigling");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'wiggling'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace merlin
