// Measures the car in rendered pictures and compares it with its description.
#include <gtest/gtest.h>

#include "sim/color/renderer.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

constexpr double kDistance_m = 40.0, kFocal_px = 32'000.0;  // 800 pixels per metre, nearly parallel rays
const CameraModel kFar{
    .width = 640, .height = 480, .fx_px = kFocal_px, .fy_px = kFocal_px, .cx_px = 319.5, .cy_px = 239.5};

std::vector<std::uint8_t> PictureOf(const World& world, const Pose& T_world_camera) {
  Renderer renderer(world.model(), kFar, Gl::kAuto);
  RenderSnapshot snapshot(world.model());
  snapshot.Take(world.model(), world.data(), T_world_camera, kFar);
  std::vector<std::uint8_t> bgr(static_cast<std::size_t>(kFar.width) * kFar.height * 3);
  renderer.Draw(snapshot, bgr);
  return bgr;
}

// Extent of the car in the picture [m], about its middle: where the picture differs from the same one without the car.
Eigen::AlignedBox2d Silhouette_m(const Eigen::Vector3d& middle, const Eigen::Matrix3d& rotation) {
  Pose T_world_camera = Pose::Identity();
  T_world_camera.linear() = rotation;
  T_world_camera.translation() = middle - kDistance_m * rotation.col(2);
  const std::string room = Room(kPlane, "<visual><map zfar=\"100\"/></visual>");
  const auto with = PictureOf(*MakeWorld(room), T_world_camera);
  const auto without = PictureOf(*MakeWorld(room, FromXyYaw(0.0, 90.0, 0.0)), T_world_camera);
  Eigen::AlignedBox2d box;
  for (int v = 0; v < kFar.height; ++v)
    for (int u = 0; u < kFar.width; ++u) {
      const std::size_t at = 3 * (static_cast<std::size_t>(v) * kFar.width + u);
      if (std::equal(with.begin() + at, with.begin() + at + 3, without.begin() + at)) continue;
      box.extend(Eigen::Vector2d(u - kFar.cx_px, v - kFar.cy_px) * kDistance_m / kFocal_px);
    }
  return box;
}

// Tolerance: two pixels, plus the change of scale over 0.4 m of height at 40 m.
constexpr double kTolerance_m = 2.0 / 800.0 + 0.002;

TEST(CarPicture, IsAsLongAndWideAsTheCarFromAbove) {
  Eigen::Matrix3d down;  // the picture's right is the car's front, its lower edge the car's right
  down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const Eigen::AlignedBox2d box = Silhouette_m({0.18, 0.0, 0.0}, down);
  EXPECT_NEAR(box.min().x(), -0.09 - 0.18, kTolerance_m);
  EXPECT_NEAR(box.max().x(), 0.45 - 0.18, kTolerance_m);
  EXPECT_NEAR(box.min().y(), -0.15, kTolerance_m);
  EXPECT_NEAR(box.max().y(), 0.15, kTolerance_m);
}

TEST(CarPicture, IsAsLongAndHighAsTheCarFromItsSide) {
  Eigen::Matrix3d left;  // from the car's right: the picture's right is the car's front
  left << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Eigen::AlignedBox2d box = Silhouette_m({0.18, 0.0, 0.2}, left);
  EXPECT_NEAR(box.min().x(), -0.09 - 0.18, kTolerance_m);
  EXPECT_NEAR(box.max().x(), 0.45 - 0.18, kTolerance_m);
  EXPECT_NEAR(box.min().y(), 0.2 - (0.4176 + 0.020), kTolerance_m);  // top of the colour camera
  EXPECT_NEAR(box.max().y(), 0.2, kTolerance_m);                     // bottom of the tyres
}

}  // namespace
}  // namespace merlin::sim
