// How the time-of-flight camera measures bodies that move by themselves.
#include <gtest/gtest.h>

#include "sim/actors/actors.h"
#include "sim/world/room.h"
#include "tests/sim/tof/stage.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

// The law of four phase images taken one after the other: the range at mid-frame, plus half the distance moved in a
// sub-frame times the cosine of twice the phase. The wall is so far away that its light does not change while it moves;
// the camera is at rest.
TEST(TofActors, AWallAtOneMetreASecondErrsByHalfItsMotionInASubFrameTimesCos2Phi) {
  constexpr double kUnambiguous_m = 299792458.0 / (2 * 20e6), kSpeed_m_s = 1.0;
  const DepthSettings settings{.integration_s = 4e-3};
  const double step_m = kSpeed_m_s * (4e-3 + 1e-3);
  DepthCameraSheet sheet = Sheet3kS();
  sheet.camera = {.width = 1, .height = 1, .fx_px = 100, .fy_px = 100, .cx_px = 0, .cy_px = 0};
  const double far_m = 11.0 * kUnambiguous_m;  // of the wall's front; its middle is half a metre behind it
  const TemporaryFile room("room.xml", Room(kPlane));
  for (const double sign : {1.0, -1.0}) {
    World world({.room = room.path(),
                 .car = Merlin(),
                 .actors = {{.name = "wall",
                             .shape = "box",
                             .size_m = {1.0, 40.0, 40.0},
                             .material = "white_target",
                             .path = {{0, far_m + 0.5, 0, 0}, {8, far_m + 0.5 + sign * 8 * kSpeed_m_s, 0, 0}}}}});
    const Surroundings around = SurroundingsOf(world.model(), {});
    std::vector<bool> car(static_cast<std::size_t>(world.model()->nbody));
    for (int geom = 0; geom < world.model()->ngeom; ++geom)
      if (world.IsCarGeom(geom)) car[static_cast<std::size_t>(world.model()->geom_bodyid[geom])] = true;
    RayScene scene(world.model(), car);
    BodyMotion camera;
    camera.T_world_body.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.T_world_body.translation().z() = 5.0;
    const TofCamera tof(sheet, {}, ParseTofEffects("motion"), 1);
    double largest_m = 0.0;
    for (int i = 0; i < 25; ++i) {
      const double x_m = far_m + sign * kSpeed_m_s * Seconds(world.Now());
      const BodyMotions bodies = world.Motions();
      const DepthFrame frame = tof.Expose({scene, around, bodies, camera}, settings, Time{0}, 0);
      const double error_m = std::remainder(frame.range_m[0] - x_m, kUnambiguous_m);
      const double law_m = sign * 0.5 * step_m * std::cos(2.0 * WaveNumber(20e6) * x_m);
      EXPECT_NEAR(error_m, law_m, 0.1 * 0.5 * step_m) << "wall at " << x_m;
      largest_m = std::max(largest_m, std::abs(error_m));
      StepFor(world, 0.3);
    }
    EXPECT_GT(largest_m, 0.9 * 0.5 * step_m);
  }
}

// Traces every sub-ray of every sub-frame and adds the phasors in double precision. It must make no difference that the
// camera computes ranges of known planes without tracing. Actors are at their poses at the middle of the sub-frame.
TEST(TofActors, SumsWhatEverySubRayMeetsWhereActorsThenAre) {
  const std::filesystem::path models = std::filesystem::path(MERLIN_SOURCE_DIR) / "models";
  const std::vector<ActorConfig> actors{
      {.name = "cart", .shape = "box", .size_m = {0.4, 0.5, 0.6}, .path = {{0, -1.2, -9.6, 0.3}}},
      {.name = "ball", .shape = "sphere", .size_m = {0.4}, .path = {{0, -0.6, -9.0}}},
      {.name = "person", .model = models / "actors/person.xml", .path = {{0, 0.5, -9.5}}}};
  const SpecPtr spec = ReadRoom(models / "rooms/corridor_26x21.xml", false);
  Actors::AddTo(spec.get(), actors, {});
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(mj_compile(spec.get(), nullptr), mj_deleteModel);
  ASSERT_TRUE(model);
  const Surroundings around = SurroundingsOf(model.get(), ReadMaterials(models / "materials.yaml"));
  RayScene scene(model.get(), std::vector<bool>(static_cast<std::size_t>(model->nbody)), PanesOf(around));
  BodyMotions bodies = AtRest(model.get());
  const auto move = [&](const std::string& name, const Eigen::Vector3d& velocity_m_s, double turn_rad_s) {
    for (const ActorConfig& actor : actors)
      if (actor.name == name)
        bodies[static_cast<std::size_t>(mj_name2id(model.get(), mjOBJ_BODY, ("actor_" + name).c_str()))] = {
            TimedPath(actor.path).At(0.0).T_world_body, velocity_m_s, {0, 0, turn_rad_s}};
  };
  move("cart", {-0.3, 1.0, 0}, 1.0);
  move("ball", {0, -2.0, 0}, 0);
  move("person", {-1.0, 0.5, 0}, 0);
  BodyMotion camera;
  camera.T_world_body.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.T_world_body.translation() = Eigen::Vector3d(-3.0, -9.3, 0.35);
  camera.velocity_m_s = {0.5, 0, 0};
  const DepthCameraSheet sheet = Sheet3kS();
  const TofView view{scene, around, bodies, camera};
  const DepthFrame frame = TofCamera(sheet, {}, ParseTofEffects("flying,motion"), 1).Expose(view, {}, Time{0}, 0);
  std::vector<std::array<double, 4>> D(64 * 48);
  int on_actors = 0;
  for (int k = 0; k < 4; ++k) {
    scene.Update(bodies, (k - 1.5) * 2e-3);
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 64; ++u)
        for (int s = 0; s < 9; ++s) {
          const int i = s % 3, j = s / 3;
          const Pose T_world_camera = camera.At((k - 1.5) * 2e-3 + ((i + j) % 3 - 1) * 1e-3 / 3.0);
          const Eigen::Vector3d direction =
              T_world_camera.linear() * sheet.camera.Ray(u + (i - 1) / 3.0, v + (j - 1) / 3.0);
          const Ray ray{T_world_camera.translation().cast<float>(), direction.cast<float>()};
          RayHit hit;
          scene.Cast(std::span(&ray, 1), std::span(&hit, 1));
          if (hit.geom < 0) continue;
          on_actors += !bodies[static_cast<std::size_t>(scene.BodyOf(hit.geom))].still();
          const double albedo = around.material[static_cast<std::size_t>(hit.geom)].nir_albedo;
          D[Pixel(u, v)][static_cast<std::size_t>(k)] += albedo * -hit.normal.cast<double>().dot(direction) /
                                                         std::pow(hit.range_m, 2) *
                                                         std::cos(WaveNumber(20e6) * hit.range_m + k * kPi / 2);
        }
  }
  EXPECT_GT(on_actors, 9 * 4 * 200);
  int off = 0;
  double worst_m = 0.0;
  for (std::size_t p = 0; p < D.size(); ++p) {
    const double range_m = std::atan2(D[p][3] - D[p][1], D[p][0] - D[p][2]) / WaveNumber(20e6);
    const double error_m = std::abs(std::remainder(frame.range_m[p] - range_m, UnambiguousRange_m(20e6)));
    off += error_m > 1e-4;
    worst_m = std::max(worst_m, error_m);
  }
  EXPECT_LE(off, 64 * 48 / 500) << "worst " << worst_m << " m";
}

}  // namespace
}  // namespace merlin::sim
