#include "sim/color/renderer.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "robot/base/error.h"

namespace merlin::sim {
namespace {

// Table 4.3 of the thesis: principal point off the centre, two different focal lengths.
const CameraModel kCcd{
    .width = 640, .height = 480, .fx_px = 780.037, .fy_px = 777.844, .cx_px = 353.244, .cy_px = 223.784};
const CameraModel kSkew{.width = 200, .height = 120, .fx_px = 150.0, .fy_px = 240.0, .cx_px = 60.5, .cy_px = 80.25};

// A MuJoCo model at its initial state.
struct Scene {
  explicit Scene(mjModel* m) : model(m), data(m ? mj_makeData(m) : nullptr) {
    if (!m) throw std::runtime_error("the test's model does not load");
    mj_forward(model, data);
  }
  ~Scene() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  mjModel* model;
  mjData* data;
};

std::unique_ptr<Scene> FromText(const std::string& body) {
  const std::string xml =
      "<mujoco><visual><headlight ambient='0 0 0' diffuse='0 0 0' specular='0 0 0'/></visual><asset>"
      "<material name='white' rgba='1 1 1 1' emission='1'/><material name='red' rgba='1 0 0 1' emission='1'/>"
      "<material name='green' rgba='0 1 0 1' emission='1'/><material name='blue' rgba='0 0 1 1' emission='1'/>"
      "</asset><worldbody>" +
      body + "</worldbody></mujoco>";
  char error[500] = "";
  mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error));
  auto scene = std::make_unique<Scene>(spec ? mj_compile(spec, nullptr) : nullptr);
  mj_deleteSpec(spec);
  return scene;
}

std::unique_ptr<Scene> RoomScene(const std::string& name) {
  char error[500] = "";
  const std::string file = std::string(MERLIN_SOURCE_DIR "/models/rooms/") + name + ".xml";
  return std::make_unique<Scene>(mj_loadXML(file.c_str(), nullptr, error, sizeof(error)));
}

// A level camera at this position and yaw: optical z ahead, x right, y down.
Pose LevelCamera(const Eigen::Vector3d& position_m, double yaw_rad) {
  Pose T = Pose::Identity();
  T.linear().col(0) = Eigen::Vector3d(std::sin(yaw_rad), -std::cos(yaw_rad), 0.0);
  T.linear().col(1) = -Eigen::Vector3d::UnitZ();
  T.linear().col(2) = Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  T.translation() = position_m;
  return T;
}

std::string Text(const Eigen::Vector3d& v) {
  return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
}

using Picture = std::vector<std::uint8_t>;

Picture Draw(Renderer& renderer, RenderSnapshot& snapshot, const CameraModel& camera) {
  Picture bgr(static_cast<std::size_t>(camera.width) * camera.height * 3);
  renderer.Draw(snapshot, bgr);
  return bgr;
}

Picture Draw(Renderer& renderer, const Scene& scene, const Pose& T_world_camera, const CameraModel& camera) {
  RenderSnapshot snapshot(scene.model);
  snapshot.Take(scene.model, scene.data, T_world_camera, camera);
  return Draw(renderer, snapshot, camera);
}

struct Blob {
  double u = 0.0, v = 0.0;
  int pixels = 0;
};

// Centroid of the pixels whose channel (0 blue, 1 green, 2 red) is bright.
Blob Bright(const Picture& bgr, const CameraModel& camera, int channel) {
  Blob blob;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      if (bgr[3 * (static_cast<std::size_t>(v) * camera.width + u) + channel] > 128) {
        blob.u += u;
        blob.v += v;
        ++blob.pixels;
      }
  blob.u /= std::max(blob.pixels, 1);
  blob.v /= std::max(blob.pixels, 1);
  return blob;
}

// Why this back end cannot draw here; none if it can.
std::optional<std::string> WhyNot(Gl gl) {
  try {
    const auto scene = FromText("");
    const Renderer renderer(scene->model, kSkew, gl);
    return std::nullopt;
  } catch (const MachineError& error) {
    return error.what();
  }
}

// Uses two processes, one for each back end, because MuJoCo binds GL once per process. This test comes first, before GL
// is bound in our own process.
TEST(RendererBackEnds, EglAndOsmesaGiveTheSameBytes) {
  const std::size_t size = 640 * 480 * 3;
  auto* shared =
      static_cast<std::uint8_t*>(mmap(nullptr, 2 * size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(shared, MAP_FAILED);
  enum Exit { kDrawn = 0, kNoGl = 3 };
  const std::array<Gl, 2> back_ends{Gl::kEgl, Gl::kOsmesa};
  for (int i = 0; i < 2; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      int code = 1;
      try {
        const auto room = RoomScene("corridor_26x21");
        Renderer renderer(room->model, kCcd, back_ends[i]);
        const Picture bgr = Draw(renderer, *room, LevelCamera({0.2, -9.5, 0.41}, 0.0), kCcd);
        std::memcpy(shared + i * size, bgr.data(), size);
        code = kDrawn;
      } catch (const MachineError&) {
        code = kNoGl;
      } catch (...) {
      }
      _exit(code);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == kNoGl) {
      munmap(shared, 2 * size);
      GTEST_SKIP() << (i == 0 ? "EGL" : "OSMesa") << " does not work on this machine";
    }
    ASSERT_EQ(WEXITSTATUS(status), kDrawn);
  }
  EXPECT_GT(*std::max_element(shared, shared + size), 100);
  EXPECT_EQ(std::memcmp(shared, shared + size, size), 0);
  munmap(shared, 2 * size);
}

class RendererTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = WhyNot(Gl::kAuto)) GTEST_SKIP() << *why;
  }
};

TEST_F(RendererTest, PutsPointsWhereThePinholeModelSays) {
  // A camera anywhere, turned about all axes.
  Pose T_world_camera = LevelCamera({3.0, -2.0, 1.5}, 2.1);
  T_world_camera.linear() = T_world_camera.linear() * ExpSo3({0.2, -0.1, 0.3});
  for (const CameraModel& camera : {kCcd, kSkew}) {
    for (const Eigen::Vector2d& wanted :
         {Eigen::Vector2d(30, 30), Eigen::Vector2d(150, 25), Eigen::Vector2d(100.3, 60.7), Eigen::Vector2d(20, 100),
          Eigen::Vector2d(170, 95)}) {
      // Computed by hand: the point 2 m ahead that projects to this pixel.
      const double scale = camera.width / 200.0;
      const double u = wanted.x() * scale, v = wanted.y() * scale;
      const Eigen::Vector3d point_camera(2.0 * (u - camera.cx_px) / camera.fx_px,
                                         2.0 * (v - camera.cy_px) / camera.fy_px, 2.0);
      const Eigen::Vector3d point_world = T_world_camera.linear() * point_camera + T_world_camera.translation();
      const auto scene = FromText("<geom size='.04' material='white' pos='" + Text(point_world) + "'/>");
      Renderer renderer(scene->model, camera, Gl::kAuto);
      const Blob blob = Bright(Draw(renderer, *scene, T_world_camera, camera), camera, 1);
      ASSERT_GT(blob.pixels, 4);
      // Tolerance: the pixel raster, plus the outward stretch of a sphere's image off the axis, below 0.1 px here.
      EXPECT_NEAR(blob.u, u, 0.25);
      EXPECT_NEAR(blob.v, v, 0.25);
    }
  }
}

TEST_F(RendererTest, HasLeftOnTheLeftUpAboveAndBlueFirst) {
  const auto scene = FromText(
      "<geom size='.05' material='red' pos='2 .3 1'/>"      // left
      "<geom size='.05' material='green' pos='2 -.3 1'/>"   // right
      "<geom size='.05' material='blue' pos='2 0 1.2'/>");  // above
  Renderer renderer(scene->model, kCcd, Gl::kAuto);
  const Picture bgr = Draw(renderer, *scene, LevelCamera({0, 0, 1}, 0.0), kCcd);
  const Blob blue = Bright(bgr, kCcd, 0), green = Bright(bgr, kCcd, 1), red = Bright(bgr, kCcd, 2);
  ASSERT_GT(std::min({blue.pixels, green.pixels, red.pixels}), 100);
  EXPECT_LT(red.u, kCcd.cx_px - 100.0);
  EXPECT_GT(green.u, kCcd.cx_px + 100.0);
  EXPECT_NEAR(red.v, kCcd.cy_px, 1.0);
  EXPECT_NEAR(blue.u, kCcd.cx_px, 1.0);
  EXPECT_LT(blue.v, kCcd.cy_px - 70.0);
}

TEST_F(RendererTest, DrawsOnlyVisibleGroupsInFrontOfTheNearPlane) {
  const auto scene = FromText(
      "<geom size='.05' material='red' pos='2 0 1' group='3'/>"
      "<site size='.05' material='green' pos='2 0 1'/>"
      "<geom type='box' size='.002 .1 .1' material='blue' pos='.04 0 1'/>");
  Renderer renderer(scene->model, kCcd, Gl::kAuto);
  const Picture bgr = Draw(renderer, *scene, LevelCamera({0, 0, 1}, 0.0), kCcd);
  for (const int channel : {0, 1, 2}) EXPECT_EQ(Bright(bgr, kCcd, channel).pixels, 0) << channel;

  const auto farther = FromText("<geom type='box' size='.002 .1 .1' material='blue' pos='.06 0 1'/>");
  Renderer other(farther->model, kCcd, Gl::kAuto);
  EXPECT_EQ(Bright(Draw(other, *farther, LevelCamera({0, 0, 1}, 0.0), kCcd), kCcd, 0).pixels, 640 * 480);
}

TEST_F(RendererTest, GivesTheSameBytesAgainAndFromAnotherThread) {
  const auto room = RoomScene("hall");
  const Pose T_world_camera = LevelCamera({-1.0, 0.0, 0.41}, 0.3);
  Renderer renderer(room->model, kCcd, Gl::kAuto);
  const Picture first = Draw(renderer, *room, T_world_camera, kCcd);
  const Picture elsewhere = Draw(renderer, *room, LevelCamera({1.0, 0.5, 0.41}, 3.0), kCcd);
  EXPECT_NE(first, elsewhere);
  EXPECT_EQ(first, Draw(renderer, *room, T_world_camera, kCcd));
  Picture threaded;
  std::thread([&] {
    threaded = Draw(renderer, *room, T_world_camera, kCcd);
    Renderer own(room->model, kCcd, Gl::kAuto);
    EXPECT_EQ(first, Draw(own, *room, T_world_camera, kCcd));
  }).join();
  EXPECT_EQ(first, threaded);
}

TEST_F(RendererTest, LeavesOutNothingThatCouldBeSeen) {
  const auto room = RoomScene("corridor_26x21");
  Renderer renderer(room->model, kCcd, Gl::kAuto);
  RenderSnapshot snapshot(room->model);
  for (const Pose& T_world_camera : {LevelCamera({0.2, -9.5, 0.41}, 0.0), LevelCamera({11.9, -9.2, 0.41}, 0.9),
                                     LevelCamera({12.2, 9.0, 0.41}, 2.4), LevelCamera({-12.2, 0.0, 1.0}, -1.3)}) {
    snapshot.Take(room->model, room->data, T_world_camera, kCcd);
    const int kept = snapshot.scene.ngeom;
    const Picture picture = Draw(renderer, snapshot, kCcd);
    mjvOption option;
    mjv_defaultOption(&option);
    mjvCamera as_set;
    mjv_defaultCamera(&as_set);
    as_set.type = mjCAMERA_USER;
    mjv_updateScene(room->model, room->data, &option, nullptr, &as_set, mjCAT_ALL, &snapshot.scene);
    EXPECT_LT(kept, snapshot.scene.ngeom / 2);
    EXPECT_EQ(picture, Draw(renderer, snapshot, kCcd));
  }
}

TEST_F(RendererTest, SaysSoWhenTheProcessDrawsWithTheOtherBackEnd) {
  const auto scene = FromText("");
  const Renderer renderer(scene->model, kSkew, Gl::kAuto);
  EXPECT_NE(renderer.name().find(": "), std::string::npos);
  const Gl other = renderer.name().starts_with("EGL") ? Gl::kOsmesa : Gl::kEgl;
  EXPECT_THROW(Renderer(scene->model, kSkew, other), MachineError);
  EXPECT_NO_THROW(Renderer(scene->model, kSkew, Gl::kAuto));
}

}  // namespace
}  // namespace merlin::sim
