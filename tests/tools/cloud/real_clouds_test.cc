// Real scans through the readers and the registration of free clouds.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "slam/register/align.h"
#include "tools/cloud/cloud_file.h"

namespace merlin {
namespace {

TEST(RealClouds, AlignTheBunnysScansAsPclDoes) {
  const char* shared = std::getenv("MERLIN_SHARED_DATA");
  const auto scans =
      (shared ? std::filesystem::path(shared) : std::filesystem::path(MERLIN_SOURCE_DIR) / "../shared/data") / "scans";
  if (!std::filesystem::exists(scans / "bun0.pcd")) GTEST_SKIP() << "no real scans at " << scans;
  const CloudFile source = ReadCloud(scans / "bun0.pcd"), target = ReadCloud(scans / "bun4.pcd");
  ASSERT_EQ(source.cloud.size(), 397u);
  ASSERT_EQ(target.cloud.size(), 361u);
  const AlignResult result =
      Align(source.cloud, target.cloud, Pose::Identity(), {.method = AlignMethod::kPoint, .max_distance_m = 0.05});
  EXPECT_TRUE(result.converged());
  // PCL's own test of its point-to-point ICP, rounded to four digits.
  Eigen::Matrix3d rotation;
  rotation << 0.8806, 0.0365, -0.4724, -0.0235, 0.9992, 0.0333, 0.4732, -0.0182, 0.8808;
  EXPECT_LT((result.T_target_source.linear() - rotation).cwiseAbs().maxCoeff(), 0.001);
  EXPECT_LT((result.T_target_source.translation() - Eigen::Vector3d(0.03453, -0.00152, 0.04116)).cwiseAbs().maxCoeff(),
            1e-4);
}

}  // namespace
}  // namespace merlin
