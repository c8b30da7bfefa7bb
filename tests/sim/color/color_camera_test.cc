// The whole colour camera in small worlds: projection of points, exposure, motion blur.
#include "sim/color/color_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "tests/support/thesis_ccd.h"

namespace merlin::sim {
namespace {

const CameraModel kBarrel{.width = 640,
                          .height = 480,
                          .fx_px = 500.0,
                          .fy_px = 505.0,
                          .cx_px = 310.0,
                          .cy_px = 250.0,
                          .k1 = -0.25,
                          .k2 = 0.05,
                          .p1 = 0.004,
                          .p2 = -0.003};
const CameraModel kSmall{.width = 96, .height = 64, .fx_px = 80.0, .fy_px = 80.0, .cx_px = 47.5, .cy_px = 31.5};

ColorCameraSheet NoiseFree(const CameraModel& camera) {
  return {.name = "test",
          .camera = camera,
          .full_well_e = 1e12,
          .exposure_nominal_s = 0.02,
          .exposure_min_s = 1e-4,
          .exposure_max_s = 0.04,
          .gain_max = 8.0};
}

ColorSettings Fixed(double exposure_s) { return {.exposure_s = exposure_s, .auto_exposure = false}; }

// A MuJoCo model at its initial state. Everything in it glows; there are no lights.
struct SmallWorld {
  explicit SmallWorld(const std::string& body) {
    const std::string xml =
        "<mujoco><visual><headlight ambient='0 0 0' diffuse='0 0 0' specular='0 0 0'/></visual><asset>"
        "<material name='white' rgba='1 1 1 1' emission='1'/><material name='dim' rgba='.2 .2 .2 1' emission='1'/>"
        "</asset><worldbody>" +
        body + "</worldbody></mujoco>";
    char error[500] = "";
    mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error));
    model = spec ? mj_compile(spec, nullptr) : nullptr;
    mj_deleteSpec(spec);
    if (!model) throw std::runtime_error("the test's model does not load");
    data = mj_makeData(model);
    mj_forward(model, data);
  }
  ~SmallWorld() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  mjModel* model;
  mjData* data;
};

// Optical z along the world's x, optical x along -y, optical y along -z; then turned by the rotation vector.
Pose CameraAt(const Eigen::Vector3d& position_m, const Eigen::Vector3d& turn_rad = {0, 0, 0}) {
  Pose T = Pose::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.linear() = T.linear() * ExpSo3(turn_rad);
  T.translation() = position_m;
  return T;
}

// OpenCV's documentation of its calib3d module, "detailed description".
Eigen::Vector2d PixelOf(const CameraModel& c, const Eigen::Vector3d& p) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y, radial = 1.0 + c.k1 * r2 + c.k2 * r2 * r2;
  const double x2 = x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x);
  const double y2 = y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y;
  return {c.fx_px * x2 + c.cx_px, c.fy_px * y2 + c.cy_px};
}

double Linear(int value) {  // IEC 61966-2-1
  return value <= 10 ? value / 255.0 / 12.92 : std::pow((value / 255.0 + 0.055) / 1.055, 2.4);
}

int Green(const ColorFrame& frame, int u, int v) {
  return frame.bgr[3 * (static_cast<std::size_t>(v) * frame.width + u) + 1];
}

// Centroid of the green light within a few pixels of a position.
Eigen::Vector2d Centroid(const ColorFrame& frame, const Eigen::Vector2d& about, int radius) {
  Eigen::Vector2d sum(0, 0);
  double light = 0.0;
  const int u0 = static_cast<int>(std::lround(about.x())), v0 = static_cast<int>(std::lround(about.y()));
  for (int v = std::max(0, v0 - radius); v <= std::min(frame.height - 1, v0 + radius); ++v)
    for (int u = std::max(0, u0 - radius); u <= std::min(frame.width - 1, u0 + radius); ++u) {
      light += Green(frame, u, v);
      sum += Green(frame, u, v) * Eigen::Vector2d(u, v);
    }
  return sum / light;
}

class ColorCameraTest : public testing::Test {
 protected:
  void SetUp() override {
    try {
      const SmallWorld world("");
      const ColorCamera camera(world.model, NoiseFree(kSmall), Gl::kAuto, 1, false);
    } catch (const MachineError& error) {
      GTEST_SKIP() << error.what();
    }
  }
};

TEST_F(ColorCameraTest, PutsMarkersWhereOpenCvsModelProjectsThem) {
  const Pose T_world_camera = CameraAt({1.0, -2.0, 1.5}, {0.2, -0.1, 0.3});
  for (const CameraModel& model : {kThesisCcd, kBarrel}) {
    std::string markers;
    std::vector<Eigen::Vector3d> points_camera;
    for (double y = -0.45; y <= 0.46; y += 0.09)
      for (double x = -0.6; x <= 0.61; x += 0.1) {
        const Eigen::Vector3d point_camera = 2.0 * Eigen::Vector3d(x, y, 1.0);
        const Eigen::Vector2d pixel = PixelOf(model, point_camera);
        if (pixel.x() < 12 || pixel.y() < 12 || pixel.x() > model.width - 13 || pixel.y() > model.height - 13) continue;
        const Eigen::Vector3d p = T_world_camera * point_camera;
        markers += "<geom size='.018' material='white' pos='" + std::to_string(p.x()) + " " + std::to_string(p.y()) +
                   " " + std::to_string(p.z()) + "'/>";
        points_camera.push_back(point_camera);
      }
    ASSERT_GT(points_camera.size(), 25u);
    const SmallWorld world(markers);
    ColorCamera camera(world.model, NoiseFree(model), Gl::kAuto, 1, false);
    auto shot = camera.Take(world.model, world.data, {.T_world_body = T_world_camera});
    const ColorFrame frame = camera.Expose(*shot, Fixed(0.02), Time{7}, 3);
    double worst_px = 0.0;
    for (const Eigen::Vector3d& point : points_camera) {
      const Eigen::Vector2d pixel = PixelOf(model, point);
      worst_px = std::max(worst_px, (Centroid(frame, pixel, 11) - pixel).norm());
    }
    // Tolerance: the pixel raster, plus the outward stretch of a sphere's image off the axis, below 0.1 px.
    EXPECT_LT(worst_px, 0.3);
    EXPECT_EQ(frame.stamp, Time{7});
    EXPECT_EQ(frame.index, 3u);
  }
}

constexpr char kDimWall[] = "<geom type='box' size='.1 9 9' material='dim' pos='3 0 0'/>";

TEST_F(ColorCameraTest, ExposesByTheFrameBefore) {
  const SmallWorld world(kDimWall);
  const ColorCameraSheet sheet = NoiseFree(kSmall);
  ColorCamera camera(world.model, sheet, Gl::kAuto, 1, false);
  const auto expose = [&](const ColorSettings& settings) {
    auto shot = camera.Take(world.model, world.data, {.T_world_body = CameraAt({0, 0, 0})});
    return camera.Expose(*shot, settings, Time{0}, 0);
  };
  // 51 of 255 is a linear light of 0.033: 2.4 stops below a grey card; the first correction takes half of them.
  const ColorFrame first = expose(DefaultSettings(sheet)), second = expose(DefaultSettings(sheet));
  EXPECT_EQ(first.settings, DefaultSettings(sheet));
  EXPECT_EQ(Green(first, 48, 32), 51);
  EXPECT_NEAR(second.settings.exposure_s * second.settings.gain, 0.02 * std::sqrt(0.18 / Linear(51)), 1e-6);
  EXPECT_NEAR(Linear(Green(second, 48, 32)) / Linear(51), std::sqrt(0.18 / Linear(51)),
              0.035);  // half a quantisation step
  // With fixed exposure the settings stay; automatic again, it starts from the settings given.
  EXPECT_EQ(expose(Fixed(0.01)).settings, Fixed(0.01));
  EXPECT_EQ(expose(Fixed(0.01)).settings, Fixed(0.01));
  EXPECT_EQ(expose(DefaultSettings(sheet)).settings, DefaultSettings(sheet));
}

TEST_F(ColorCameraTest, BlursWhatItPassesAndOnlyIfAskedTo) {
  const SmallWorld world("<geom type='box' size='.01 .1 .5' material='white' pos='2 0 0'/>");
  const CameraModel model{.width = 320, .height = 32, .fx_px = 400.0, .fy_px = 400.0, .cx_px = 159.5, .cy_px = 15.5};
  // To the left at 4 m/s for 20 ms: 8 cm, which are 16 px at 1.99 m; the bar itself is 40 px wide.
  const BodyMotion moving{.T_world_body = CameraAt({0, 0, 0}), .velocity_m_s = {0, 4, 0}};
  const auto row = [&](bool motion_blur, const BodyMotion& motion) {
    ColorCamera camera(world.model, NoiseFree(model), Gl::kAuto, 1, motion_blur);
    auto shot = camera.Take(world.model, world.data, motion);
    const ColorFrame frame = camera.Expose(*shot, Fixed(0.02), Time{0}, 0);
    std::vector<double> light;
    for (int u = 0; u < model.width; ++u) light.push_back(Linear(Green(frame, u, 16)));
    return light;
  };
  const std::vector<double> sharp = row(false, moving), standing = row(true, {.T_world_body = CameraAt({0, 0, 0})});
  EXPECT_EQ(sharp, standing);
  const std::vector<double> blurred = row(true, moving);
  const auto grey = [](const std::vector<double>& light) {
    return std::count_if(light.begin(), light.end(), [](double l) { return l > 0.02 && l < 0.98; });
  };
  EXPECT_EQ(grey(sharp), 0);
  EXPECT_NEAR(static_cast<double>(grey(blurred)), 2 * 16 * 7 / 8,
              4.0);  // the mean of eight pictures has ramps of seven steps
}

// Seen from a body that moves at the same velocity, a moving body looks as if both were at rest. Seen from a camera at
// rest, it looks like a body at rest seen by a camera that moves the other way.
TEST_F(ColorCameraTest, BlursWhatMovesAsWhatItPasses) {
  const SmallWorld world("<body pos='2 0 0'><freejoint/><geom type='box' size='.01 .1 .5' material='white'/></body>");
  const CameraModel model{.width = 320, .height = 32, .fx_px = 400.0, .fy_px = 400.0, .cx_px = 159.5, .cy_px = 15.5};
  const auto picture = [&](const Eigen::Vector3d& camera_m_s, const Eigen::Vector3d& bar_m_s) {
    ColorCamera camera(world.model, NoiseFree(model), Gl::kAuto, 1, true);
    BodyMotions bodies = MotionsOf(world.model, world.data);
    bodies[1].velocity_m_s = bar_m_s;
    auto shot =
        camera.Take(world.model, world.data, {.T_world_body = CameraAt({0, 0, 0}), .velocity_m_s = camera_m_s}, bodies);
    return camera.Expose(*shot, Fixed(0.02), Time{0}, 0).bgr;
  };
  const std::vector<std::uint8_t> sharp = picture({0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(picture({0, 4, 0}, {0, 4, 0}), sharp);
  EXPECT_NE(picture({0, 0, 0}, {0, -4, 0}), sharp);
  EXPECT_EQ(picture({0, 0, 0}, {0, -4, 0}), picture({0, 4, 0}, {0, 0, 0}));
}

TEST_F(ColorCameraTest, BlursAboutTheMiddleOfTheExposureInLinearLight) {
  const SmallWorld world("<geom type='box' size='.01 .1 .5' material='white' pos='2 0 0'/>");
  const CameraModel model{.width = 320, .height = 32, .fx_px = 400.0, .fy_px = 400.0, .cx_px = 159.5, .cy_px = 15.5};
  ColorCamera camera(world.model, NoiseFree(model), Gl::kAuto, 1, true);
  // Half exposure, so that full light gives one half and nothing clips; the camera turns about the vertical axis.
  const auto expose = [&](const BodyMotion& motion) {
    auto shot = camera.Take(world.model, world.data, motion);
    return camera.Expose(*shot, Fixed(0.01), Time{0}, 0);
  };
  const Pose T = CameraAt({0, 0, 0});
  const ColorFrame sharp = expose({.T_world_body = T});
  const ColorFrame turned = expose({.T_world_body = T, .angular_velocity_rad_s = {0, 0, 5.0}});  // 20 px in 10 ms
  double sharp_light = 0.0, turned_light = 0.0, middle = 0.0;
  for (int u = 0; u < model.width; ++u) {
    sharp_light += Linear(Green(sharp, u, 16));
    turned_light += Linear(Green(turned, u, 16));
    middle += u * Linear(Green(turned, u, 16));
  }
  EXPECT_NEAR(turned_light / sharp_light, 1.0, 0.02);
  EXPECT_NEAR(middle / turned_light, 159.5, 0.3);
}

}  // namespace
}  // namespace merlin::sim
