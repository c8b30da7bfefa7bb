#include "tools/camera/bench.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "scenarios/config/names.h"
#include "sim/color/color_camera.h"
#include "tools/camera/measure.h"
#include "tools/camera/stage.h"
#include "tools/json_text.h"

namespace merlin {
namespace {

constexpr double kSpeed_m_s = 0.5, kYawRate_rad_s = 0.3, kHeight_m = 0.35;
constexpr int kRayRounds = 20;
constexpr double kActorAhead_m = 2.0, kActorSpeed_m_s = 1.0;

double Ms(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

template <class Work>
double TimeOf_ms(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return Ms(std::chrono::steady_clock::now() - start);
}

// Poses along the middle of the corridor, three in each leg, counter-clockwise; the camera as a body.
std::vector<sim::BodyMotion> Drive() {
  std::vector<sim::BodyMotion> motions;
  for (const double turn_rad : {0.0, 0.5, 1.0, 1.5}) {
    const double yaw_rad = turn_rad * std::numbers::pi;
    const bool along_x = std::abs(std::cos(yaw_rad)) > 0.5;
    for (const double along_m : {-6.0, 0.0, 6.0}) {
      const Eigen::Vector3d ahead(std::cos(yaw_rad), std::sin(yaw_rad), 0.0), right(ahead.y(), -ahead.x(), 0.0);
      sim::BodyMotion motion;
      motion.T_world_body.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      motion.T_world_body.translation() =
          along_m * ahead + (along_x ? 9.5 : 12.2) * right + Eigen::Vector3d(0.0, 0.0, kHeight_m);
      motion.velocity_m_s = kSpeed_m_s * ahead;
      motion.angular_velocity_rad_s = {0.0, 0.0, kYawRate_rad_s};
      motions.push_back(motion);
    }
  }
  return motions;
}

Stage Corridor() {
  return RoomStage({.room = RoomFile("corridor_26x21"),
                    .materials = Home() / "models/materials.yaml",
                    .T_world_body = Drive()[0].T_world_body});
}

Stage CorridorWith(const std::string& actor) {
  return RoomStage({.room = RoomFile("corridor_26x21"),
                    .materials = Home() / "models/materials.yaml",
                    .T_world_body = Drive()[0].T_world_body,
                    .actors = {{.name = actor, .model = ActorFile(actor), .path = {{0, 0, 0}}}}});
}

// A path on the floor ahead of the camera, crossing from right to left.
void PutActor(const Stage& stage, const std::string& actor, const sim::BodyMotion& camera, sim::BodyMotions& bodies) {
  const int body = mj_name2id(stage.model.get(), mjOBJ_BODY, ("actor_" + actor).c_str());
  const Pose T_camera_actor(Eigen::Translation3d(kActorAhead_m, 0.0, -kHeight_m) *
                            Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
  sim::BodyMotion& motion = bodies[static_cast<std::size_t>(body)];
  motion = {.T_world_body = camera.T_world_body * T_camera_actor};
  motion.velocity_m_s = kActorSpeed_m_s * motion.T_world_body.linear().col(0);
}

double DepthFrame_ms(const std::string& model, const std::string& actor, const Stage& stage, int threads, int frames,
                     const std::atomic<bool>& interrupted) {
  const DepthCameraSheet sheet = ReadDepthCameraSheet(CameraFile(model));
  const DepthSettings settings = NearestSettings(sheet, {});
  sim::TofCamera camera(sheet, ReadDepthCameraErrors(CameraFile(model)), sim::TofEffects{}, 1, threads);
  const std::vector<sim::BodyMotion> drive = Drive();
  std::vector<double> times_ms;
  sim::BodyMotions bodies = stage.bodies;
  for (int i = 0; i < frames && !interrupted; ++i) {
    const sim::BodyMotion body = drive[static_cast<std::size_t>(i) % drive.size()], motion = body.Of(BodyOptical());
    if (!actor.empty()) PutActor(stage, actor, body, bodies);
    const sim::TofView view{*stage.scene, stage.surroundings, bodies, motion};
    times_ms.push_back(
        TimeOf_ms([&] { (void)camera.Expose(view, settings, FromSeconds(0.05 * i), static_cast<std::uint64_t>(i)); }));
  }
  return times_ms.empty() ? 0.0 : Median(times_ms);
}

CameraBench::Color BenchColor(const Stage& stage, const mjData* data, int frames,
                              const std::atomic<bool>& interrupted) {
  const ColorCameraSheet sheet = ReadColorCameraSheet(CameraFile("ccd"));
  sim::ColorCamera camera(stage.model.get(), sheet, sim::Gl::kAuto, 1, false);
  const std::vector<sim::BodyMotion> drive = Drive();
  std::vector<double> times_ms;
  for (int i = 0; i < frames && !interrupted; ++i) {
    const sim::BodyMotion motion = drive[static_cast<std::size_t>(i) % drive.size()].Of(BodyOptical());
    times_ms.push_back(TimeOf_ms([&] {
      const auto shot = camera.Take(stage.model.get(), data, motion);
      (void)camera.Expose(*shot, DefaultSettings(sheet), FromSeconds(0.1 * i), static_cast<std::uint64_t>(i));
    }));
  }
  return {
      sheet.name, camera.gl_name(), sheet.camera.width, sheet.camera.height, times_ms.empty() ? 0.0 : Median(times_ms),
      12.0};
}

// One ray per pixel and sub-ray of a 64 x 48 camera with 3 x 3 sub-rays.
void BenchRays(const Stage& stage, mjData* data, CameraBench& bench) {
  const CameraModel lens = ReadDepthCameraSheet(CameraFile("pmd_3k_s")).camera;
  std::vector<double> ours_ms, theirs_ms;
  for (int round = 0; round < kRayRounds; ++round) {
    const std::vector<sim::BodyMotion> drive = Drive();
    const Pose T_world_optical = drive[static_cast<std::size_t>(round) % drive.size()].T_world_body * BodyOptical();
    const Eigen::Vector3d origin = T_world_optical.translation();
    std::vector<sim::Ray> rays;
    std::vector<mjtNum> directions;
    for (int v = 0; v < 3 * lens.height; ++v)
      for (int u = 0; u < 3 * lens.width; ++u) {
        const Eigen::Vector3d direction = T_world_optical.linear() * lens.Ray((u - 1) / 3.0, (v - 1) / 3.0);
        rays.push_back({origin.cast<float>(), direction.cast<float>()});
        directions.insert(directions.end(), direction.data(), direction.data() + 3);
      }
    std::vector<sim::RayHit> hits(rays.size());
    ours_ms.push_back(TimeOf_ms([&] { stage.scene->Cast(rays, hits); }));
    constexpr mjtByte kVisible[mjNGROUP] = {1, 1, 1, 0, 0, 0};
    std::vector<int> geoms(rays.size());
    std::vector<mjtNum> ranges_m(rays.size()), normals(3 * rays.size());
    theirs_ms.push_back(TimeOf_ms([&] {
      mj_multiRay(stage.model.get(), data, origin.data(), directions.data(), kVisible, 1, -1, geoms.data(),
                  ranges_m.data(), normals.data(), static_cast<int>(rays.size()), 100.0);
    }));
    if (round > 0) continue;
    bench.rays_per_s = bench.multi_ray_per_s = 1e3 * static_cast<double>(rays.size());
  }
  bench.rays_per_s /= Median(ours_ms);
  bench.multi_ray_per_s /= Median(theirs_ms);
}

}  // namespace

CameraBench BenchCamera(int threads, const std::atomic<bool>& interrupted) {
  CameraBench bench{.threads = threads};
  const Stage stage = Corridor();
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(stage.model.get()), mj_deleteData);
  mj_forward(stage.model.get(), data.get());
  bench.depth = {{.model = "pmd_3k_s", .limit_one_thread_ms = 8.0, .limit_two_threads_ms = 5.0},
                 {.model = "pmd_3k_s", .actor = "person", .limit_one_thread_ms = 8.0, .limit_two_threads_ms = 5.0},
                 {.model = "camcube_3", .limit_one_thread_ms = 80.0, .limit_two_threads_ms = 45.0}};
  for (CameraBench::Depth& depth : bench.depth) {
    const CameraModel lens = ReadDepthCameraSheet(CameraFile(depth.model)).camera;
    depth.width = lens.width;
    depth.height = lens.height;
    const Stage with = depth.actor.empty() ? Stage{} : CorridorWith(depth.actor);
    const auto frame_ms = [&](int of_threads) {
      return DepthFrame_ms(depth.model, depth.actor, depth.actor.empty() ? stage : with, of_threads, bench.frames,
                           interrupted);
    };
    depth.one_thread_ms = frame_ms(1);
    depth.threads_ms = frame_ms(threads);
  }
  BenchRays(stage, data.get(), bench);
  try {
    bench.color = BenchColor(stage, data.get(), bench.frames, interrupted);
  } catch (const MachineError& error) {
    bench.no_color = error.what();
  }
  return bench;
}

std::string Table(const CameraBench& bench) {
  std::string text = fmt::format("in corridor_26x21, driving at {:g} m/s and {:g} rad/s; median of {} frames\n",
                                 kSpeed_m_s, kYawRate_rad_s, bench.frames);
  text += fmt::format("  {:<34} {:>10} {:>10}   {}\n", "", "1 thread", fmt::format("{} threads", bench.threads),
                      "limit (1 / 2 threads)");
  for (const CameraBench::Depth& depth : bench.depth)
    text += fmt::format("  {:<34} {:>7.2f} ms {:>7.2f} ms   {:g} / {:g} ms\n",
                        fmt::format("{} {}x{}, {}", depth.model, depth.width, depth.height,
                                    depth.actor.empty() ? "all effects" : "a moving " + depth.actor),
                        depth.one_thread_ms, depth.threads_ms, depth.limit_one_thread_ms, depth.limit_two_threads_ms);
  if (bench.color)
    text += fmt::format("  {:<34} {:>7.2f} ms {:>10}   {:g} ms ({})\n",
                        fmt::format("{} {}x{}, colour", bench.color->model, bench.color->width, bench.color->height),
                        bench.color->frame_ms, "", bench.color->limit_ms, bench.color->gl);
  else
    text += fmt::format("  {:<34} not measured: {}\n", "colour", bench.no_color);
  return text + fmt::format("  {:<34} {:>7.1f} million rays/s\n  {:<34} {:>7.1f} million rays/s, the same rays\n",
                            "RayScene::Cast", 1e-6 * bench.rays_per_s, "mj_multiRay", 1e-6 * bench.multi_ray_per_s);
}

std::string ToJson(const CameraBench& bench) {
  nlohmann::ordered_json json{{"room", "corridor_26x21"},
                              {"frames", bench.frames},
                              {"threads", bench.threads},
                              {"depth", nlohmann::ordered_json::array()}};
  for (const CameraBench::Depth& depth : bench.depth)
    json["depth"].push_back(
        {{"model", depth.model},
         {"actor", depth.actor.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(depth.actor)},
         {"width", depth.width},
         {"height", depth.height},
         {"one_thread_ms", depth.one_thread_ms},
         {"threads_ms", depth.threads_ms},
         {"limit_one_thread_ms", depth.limit_one_thread_ms},
         {"limit_two_threads_ms", depth.limit_two_threads_ms}});
  json["color"] = nullptr;
  if (bench.color)
    json["color"] = {{"model", bench.color->model},       {"width", bench.color->width},
                     {"height", bench.color->height},     {"gl", bench.color->gl},
                     {"frame_ms", bench.color->frame_ms}, {"limit_ms", bench.color->limit_ms}};
  else
    json["no_color"] = bench.no_color;
  json["rays_per_s"] = bench.rays_per_s;
  json["multi_ray_per_s"] = bench.multi_ray_per_s;
  return JsonText(json);
}

}  // namespace merlin
