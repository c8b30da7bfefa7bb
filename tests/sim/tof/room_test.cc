// The camera in our rooms, compared with rays traced one by one, brute force, and the results of the experiments.
#include "sim/world/room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "robot/description/description.h"
#include "tests/sim/tof/stage.h"

namespace merlin::sim {
namespace {

const std::filesystem::path kModels = std::filesystem::path(MERLIN_SOURCE_DIR) / "models";
using ModelPtr = std::unique_ptr<mjModel, void (*)(mjModel*)>;

struct RoomView {
  explicit RoomView(const std::string& name, bool curtain_closed = false)
      : model(mj_compile(ReadRoom(kModels / "rooms" / (name + ".xml"), curtain_closed).get(), nullptr), mj_deleteModel),
        around(SurroundingsOf(model.get(), ReadMaterials(kModels / "materials.yaml"))),
        bodies(AtRest(model.get())),
        scene(model.get(), std::vector<bool>(static_cast<std::size_t>(model->nbody), false), PanesOf(around)) {}
  TofView At(double x_m, double y_m, double z_m, double yaw_rad) {
    BodyMotion camera;
    camera.T_world_body.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.T_world_body.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * camera.T_world_body.linear();
    camera.T_world_body.translation() = Eigen::Vector3d(x_m, y_m, z_m);
    return {scene, around, bodies, camera};
  }
  ModelPtr model;
  Surroundings around;
  BodyMotions bodies;
  RayScene scene;
};

// Traces every sub-ray of every sub-frame at its own instant, and adds the phasors in double precision.
TEST(TofCamera, SumsWhatEverySubRayMeetsAtItsOwnInstant) {
  RoomView room("corridor_26x21");
  TofView view = room.At(-3.0, -9.3, 0.35, 0.2);
  view.camera.velocity_m_s = {0.5, 0.05, 0};
  view.camera.angular_velocity_rad_s = {0, 0, 0.4};
  const DepthCameraSheet sheet = Sheet3kS();
  const DepthFrame frame = TofCamera(sheet, {}, ParseTofEffects("flying,motion"), 1).Expose(view, {}, Time{0}, 0);
  double worst_m = 0.0;
  int off = 0, pixels = 0;
  for (int v = 0; v < 48; v += 2) {
    for (int u = 0; u < 64; ++u) {
      double D[4] = {};
      for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 3; ++j) {
          for (int i = 0; i < 3; ++i) {
            // Sub-frames of 1 ms, 1 ms apart, about mid-exposure; three instants in each.
            const double t_s = (k - 1.5) * 2e-3 + ((i + j) % 3 - 1) * 1e-3 / 3.0;
            const Pose T_world_camera = view.camera.At(t_s);
            const Eigen::Vector3d direction =
                T_world_camera.linear() * sheet.camera.Ray(u + (i - 1) / 3.0, v + (j - 1) / 3.0);
            const Ray ray{T_world_camera.translation().cast<float>(), direction.cast<float>()};
            RayHit hit;
            room.scene.Cast(std::span(&ray, 1), std::span(&hit, 1));
            if (hit.geom < 0) continue;
            const double albedo = room.around.material[static_cast<std::size_t>(hit.geom)].nir_albedo;
            D[k] += albedo * -hit.normal.cast<double>().dot(direction) / std::pow(hit.range_m, 2) *
                    std::cos(WaveNumber(20e6) * hit.range_m + k * kPi / 2);
          }
        }
      }
      const double range_m = std::atan2(D[3] - D[1], D[0] - D[2]) / WaveNumber(20e6);
      const double error_m = std::abs(std::remainder(frame.range_m[Pixel(u, v)] - range_m, UnambiguousRange_m(20e6)));
      ++pixels;
      off += error_m > 1e-4;
      worst_m = std::max(worst_m, error_m);
    }
  }
  EXPECT_LE(off, pixels / 1000) << "of " << pixels << ", worst " << worst_m << " m";
}

TEST(TofTruth, IsWhatTheIdealCameraReadsAndWhereItIs) {
  RoomView room("corridor_26x21");
  TofView view = room.At(-3.0, -9.3, 0.35, 0.2);
  view.camera.velocity_m_s = {0.5, 0, 0};
  const DepthCameraSheet sheet = Sheet3kS();
  const TofTruth truth = TofCamera(sheet, {}, {}, 1).Truth(view, {}, Time{0});
  const DepthFrame ideal = TofCamera(sheet, {}, kIdealTof, 1).Expose(view, {}, Time{0}, 0);
  ASSERT_EQ(truth.range_m.size(), 64u * 48u);
  ASSERT_EQ(truth.T_world_camera.size(), 4u);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(truth.T_world_camera[static_cast<std::size_t>(k)].translation().x(), -3.0 + 0.5 * (k - 1.5) * 2e-3,
                1e-12);
  int mixed = 0;
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      const std::size_t p = Pixel(u, v);
      ASSERT_NEAR(std::remainder(ideal.range_m[p] - truth.range_m[p], UnambiguousRange_m(20e6)), 0.0, 2e-5);
      EXPECT_NEAR(truth.depth_m[p], truth.range_m[p] * sheet.camera.Ray(u, v).z(), 1e-5);
      // Oracle: MuJoCo's own ray.
      const Eigen::Vector3d direction = view.camera.T_world_body.linear() * sheet.camera.Ray(u, v);
      if ((u + v) % 16 == 0) {
        const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(room.model.get()), mj_deleteData);
        mj_kinematics(room.model.get(), data.get());
        const mjtByte groups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
        int geom = -1;
        const double range_m = mj_ray(room.model.get(), data.get(), view.camera.T_world_body.translation().data(),
                                      direction.data(), groups, 1, -1, &geom, nullptr);
        EXPECT_NEAR(truth.range_m[p], range_m, 2e-3);
        EXPECT_EQ(truth.material[p], room.model->geom_matid[truth.geom[p]]);
      }
      mixed += truth.mixed[p];
    }
  }
  EXPECT_GT(mixed, 100);
  EXPECT_LT(mixed, 64 * 48 / 2);
  std::map<std::string, double> largest_m;
  for (const TofTruth::Bias& bias : truth.bias)
    for (const float range_m : bias.range_m)
      largest_m[bias.effect] = std::max<double>(largest_m[bias.effect], std::abs(range_m));
  EXPECT_GT(largest_m.at("wiggling"), 0.003);
  EXPECT_LT(largest_m.at("wiggling"), 0.008);  // what remains after calibration
  EXPECT_GT(largest_m.at("flying"), 0.05);
  EXPECT_FALSE(largest_m.contains("noise"));
}

TEST(TofTruth, PredictsTheSpreadOfRepeatedFrames) {
  const Stage stage({Wall(3.0, 0.4), {{1.5, 0.3, 0}, {0.1, 0.4, 0.4}, {.nir_albedo = 0.1}}});
  const TofCamera camera(Sheet3kS(), {}, {}, 1);
  const TofTruth truth = camera.Truth(stage.view(), {}, Time{0});
  constexpr int kFrames = 400;
  std::vector<DepthFrame> frames;
  for (std::uint64_t i = 0; i < kFrames; ++i) frames.push_back(camera.Expose(stage.view(), {}, Time{0}, i));
  double ratio_sum = 0.0;
  int pixels = 0;
  for (std::size_t p = 5; p < frames[0].size(); p += 61) {
    if (frames[0].flags[p] & (kSaturated | kLowSignal)) continue;
    double sum = 0.0, squares = 0.0;
    for (const DepthFrame& frame : frames)
      sum += frame.range_m[p], squares += static_cast<double>(frame.range_m[p]) * frame.range_m[p];
    const double sigma_m = std::sqrt((squares - sum * sum / kFrames) / (kFrames - 1));
    EXPECT_NEAR(sigma_m / truth.sigma_m[p], 1.0, 0.2) << p;  // 400 samples: one sigma is 3.5 %
    ratio_sum += sigma_m / truth.sigma_m[p];
    ++pixels;
  }
  EXPECT_GT(pixels, 30);
  EXPECT_NEAR(ratio_sum / pixels, 1.0, 0.03);
}

// 95th percentile of |range - truth| (wrapped to half a period at most) over the pixels that a user would use, for
// cameras in the middle of the room that look along these yaws.
double ErrorP95_m(RoomView& room, const std::vector<double>& yaws_deg) {
  const DepthCameraSheet sheet = ReadDepthCameraSheet(kModels / "cameras/pmd_3k_s.yaml");
  const DepthCameraErrors errors = ReadDepthCameraErrors(kModels / "cameras/pmd_3k_s.yaml");
  const TofCamera camera(sheet, errors, {}, 1, 2);
  const TofCamera ideal(sheet, errors, kIdealTof, 1, 2);
  std::vector<double> errors_m;
  for (const double yaw_deg : yaws_deg) {
    const TofView view = room.At(0.0, 0.0, 0.6, yaw_deg * kPi / 180.0);
    const DepthFrame frame = camera.Expose(view, {}, Time{0}, 0), truth = ideal.Expose(view, {}, Time{0}, 0);
    for (std::size_t p = 0; p < frame.size(); ++p)
      if (!(truth.flags[p] & kInvalid))
        errors_m.push_back(std::abs(std::remainder(frame.range_m[p] - truth.range_m[p], UnambiguousRange_m(20e6))));
  }
  const auto at = errors_m.begin() + static_cast<std::ptrdiff_t>(errors_m.size() * 95 / 100);
  std::ranges::nth_element(errors_m, at);
  return *at;
}

TEST(TofSunlight, DistortsTheWindowSideUntilTheCurtainIsClosed) {
  const std::vector<double> windows{-130, -110, -90, -70, -50}, others{-20, 10, 40, 70, 100, 130, 160};
  RoomView open("room_7x10", false), closed("room_7x10", true);
  const double open_windows_m = ErrorP95_m(open, windows), open_others_m = ErrorP95_m(open, others);
  EXPECT_GE(open_windows_m, 2.0 * open_others_m);
  const double closed_windows_m = ErrorP95_m(closed, windows), closed_others_m = ErrorP95_m(closed, others);
  EXPECT_LE(closed_windows_m, 1.3 * closed_others_m);
  RecordProperty("open_windows_m", std::to_string(open_windows_m));
  std::printf("p95: open %.3f and %.3f m, curtain %.3f and %.3f m\n", open_windows_m, open_others_m, closed_windows_m,
              closed_others_m);
}

}  // namespace
}  // namespace merlin::sim
