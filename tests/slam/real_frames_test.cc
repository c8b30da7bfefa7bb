// Real depth frames through the perception and registration that drive the loop.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "perception/project.h"
#include "slam/map/voxel_map.h"
#include "slam/register/align.h"
#include "slam/register/icp.h"
#include "tests/support/shared_data.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

fs::path RgbdFolder() { return SharedData("rgbd"); }

// A Kinect-class camera as a sheet: every fourth pixel each way; so little noise that its sigma is a few millimetres.
DepthCameraSheet Sheet() {
  DepthCameraSheet sheet;
  sheet.camera = {
      .width = 160, .height = 120, .fx_px = 518.0 / 4, .fy_px = 519.0 / 4, .cx_px = 325.5 / 4, .cy_px = 253.5 / 4};
  sheet.signal_e_m2_per_us = 2000.0;
  sheet.contrast_at_20mhz = 0.45;
  sheet.contrast_corner_hz = 30e6;
  sheet.read_noise_e = 200.0;
  return sheet;
}

constexpr int kWidth = 640, kHeight = 480;

// depth/N.pgm: 16 bit big-endian, 1/1000 m along the optical axis.
std::vector<double> ReadDepth_m(int number) {
  std::ifstream in(RgbdFolder() / "depth" / (std::to_string(number) + ".pgm"), std::ios::binary);
  std::string magic;
  int width = 0, height = 0, max = 0;
  in >> magic >> width >> height >> max;
  in.get();
  std::vector<unsigned char> bytes(2 * kWidth * kHeight);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  EXPECT_TRUE(in.good() && width == kWidth && height == kHeight) << number;
  std::vector<double> depth_m(bytes.size() / 2);
  for (std::size_t i = 0; i < depth_m.size(); ++i) depth_m[i] = (bytes[2 * i] * 256 + bytes[2 * i + 1]) / 1000.0;
  return depth_m;
}

bool IsValid(double depth_m) { return depth_m > 0.3 && depth_m < 6.0; }

DepthFrame ReadFrame(int number) {
  const std::vector<double> depths_m = ReadDepth_m(number);
  const CameraModel camera = Sheet().camera;
  DepthFrame frame;
  frame.width = camera.width;
  frame.height = camera.height;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double depth_m = depths_m[static_cast<std::size_t>(4 * v) * kWidth + static_cast<std::size_t>(4 * u)];
      frame.range_m.push_back(static_cast<float>(depth_m / camera.Ray(u, v).z()));
      frame.amplitude.push_back(200'000.0f);
      frame.flags.push_back(IsValid(depth_m) ? 0 : kInvalid);
    }
  }
  frame.intensity.assign(frame.size(), 128);
  return frame;
}

// Every pixel, as a free cloud in the optical frame.
Cloud ReadFreeCloud(int number) {
  const std::vector<double> depths_m = ReadDepth_m(number);
  Cloud cloud;
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const double z = depths_m[static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u)];
      if (IsValid(z)) cloud.positions.push_back({(u - 325.5) / 518.0 * z, (v - 253.5) / 519.0 * z, z});
    }
  return cloud;
}

Observation Perceive(int number) {
  const DepthCameraSheet sheet = Sheet();
  Observation observation;
  ProjectDepth(FilterDepth(ReadFrame(number), sheet, {}), sheet, PixelRays(sheet.camera), Pose::Identity(),
               observation);
  return observation;
}

std::vector<Pose> ReadPoses() {
  std::ifstream in(RgbdFolder() / "pose.txt");
  std::vector<Pose> poses;
  for (double x, y, z, qx, qy, qz, qw; in >> x >> y >> z >> qx >> qy >> qz >> qw;) {
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(x, y, z);
    pose.linear() = Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix();
    poses.push_back(pose);
  }
  return poses;
}

Vector6d FifteenCentimetresAndFiveDegrees() {
  Vector6d away;
  away.head<3>() = 0.15 * Eigen::Vector3d(1.0, -1.0, 1.0).normalized();
  away.tail<3>() = 5.0 * std::numbers::pi / 180.0 * Eigen::Vector3d(1.0, 1.0, -1.0).normalized();
  return away;
}

TEST(RealFrames, AlignNeighboursAsFreeCloudsFromFifteenCentimetresAndFiveDegreesAway) {
  if (!fs::exists(RgbdFolder() / "pose.txt")) GTEST_SKIP() << "no real frames at " << RgbdFolder();
  const std::vector<Pose> poses = ReadPoses();
  ASSERT_EQ(poses.size(), 5u);
  for (std::size_t target = 2; target <= 4; ++target) {
    const Cloud a = Thin(ReadFreeCloud(static_cast<int>(target)), 0.05);
    const Cloud b = Thin(ReadFreeCloud(static_cast<int>(target) + 1), 0.05);
    const Pose T_a_b = poses[target - 1].inverse() * poses[target];
    const AlignResult result = Align(b, a, T_a_b * Exp(FifteenCentimetresAndFiveDegrees()), {});
    const Pose error = T_a_b.inverse() * result.T_target_source;
    const double error_mm = 1e3 * error.translation().norm();
    const double error_deg = LogSo3(error.linear()).norm() * 180.0 / std::numbers::pi;
    std::printf("pair %zu-%zu: %.1f mm, %.2f deg, %d iterations\n", target, target + 1, error_mm, error_deg,
                result.iterations);
    EXPECT_TRUE(result.converged()) << target;
    EXPECT_EQ(result.method, AlignMethod::kGicp) << target;
    EXPECT_LT(error_mm, 40.0) << target;  // the given poses are another system's estimate
    EXPECT_LT(error_deg, 0.7) << target;
  }
}

TEST(RealFrames, RegisterNeighboursFromFifteenCentimetresAndFiveDegreesAway) {
  if (!fs::exists(RgbdFolder() / "pose.txt")) GTEST_SKIP() << "no real frames at " << RgbdFolder();
  const std::vector<Pose> poses = ReadPoses();
  ASSERT_EQ(poses.size(), 5u);
  for (int target = 2; target <= 4; ++target) {
    const Observation a = Perceive(target), b = Perceive(target + 1);
    const Pose T_a_b = poses[target - 1].inverse() * poses[target];
    const Vector6d away = FifteenCentimetresAndFiveDegrees();

    // Coarse to fine: a wide reach first, then sharp.
    RegisterResult result{.T_map_base = T_a_b * Exp(away)};
    for (const double voxel_m : {0.3, 0.1, 0.05}) {
      VoxelMap map({.voxel_m = voxel_m});
      map.Insert(a.points_base, Pose::Identity(), 0.0);
      IcpConfig config{.iterations_max = 60};
      config.kernel_m = 0.5 * voxel_m;
      result = Register(Downsample(b.points_base, std::min(voxel_m, 0.1)), b.camera_base, map,
                        {.T_map_base = result.T_map_base}, config);
    }
    const Pose error = T_a_b.inverse() * result.T_map_base;
    const double error_deg = LogSo3(error.linear()).norm() * 180.0 / std::numbers::pi;
    EXPECT_TRUE(result.converged) << target;
    std::printf("pair %d-%d: %.1f cm, %.2f deg, %d iterations, converged %d\n", target, target + 1,
                100.0 * error.translation().norm(), error_deg, result.iterations, result.converged);
    EXPECT_LT(error.translation().norm(), 0.095) << target;
    EXPECT_LT(error_deg, 1.0) << target;
  }
}

}  // namespace
}  // namespace merlin
