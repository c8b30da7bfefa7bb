#include "tools/cloud/write_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "scenarios/judge/writers.h"
#include "tools/cloud/cloud_file.h"

namespace merlin {
namespace {

CloudFile Read(const std::string& name, const std::string& bytes) {
  if (name.ends_with("ply")) return ParsePly(bytes, name);
  return name.ends_with("pcd") ? ParsePcd(bytes, name) : ParseCsv(bytes, name);
}

TEST(ToCloud, NearTheOriginIsThePlyOfARunsMap) {
  const std::vector<Eigen::Vector3d> positions{{1.1, -2.3, 900.0}, {0.0, 1e-20, 5.0}};
  const std::vector<Rgb> rgb{{1, 2, 3}, {255, 0, 7}};
  std::vector<MapPoint> map(2);
  for (std::size_t i = 0; i < 2; ++i) map[i].p_map = positions[i].cast<float>();
  EXPECT_EQ(ToCloud("a.ply", positions, {}), ToPly(map));
  for (std::size_t i = 0; i < 2; ++i) map[i].rgb = rgb[i];
  EXPECT_EQ(ToCloud("a", positions, rgb), ToPly(map));
}

// At each distance from the origin, up to national grids' and the largest that is read.
TEST(ToCloud, KeepsATenthOfAMillimetreAtAnyDistance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(-3.0, 3.0);
  for (const double far_m : {0.0, 100.0, 1000.0, 2000.0, 5.6e6, 9e8})
    for (const std::string name : {"a.ply", "a.pcd", "a.csv", "A.CSV"}) {
      std::vector<Eigen::Vector3d> positions;
      std::vector<Rgb> rgb;
      for (int i = 0; i < 50; ++i) {
        positions.emplace_back(far_m + within(random), within(random) - far_m, within(random));
        rgb.push_back({static_cast<std::uint8_t>(i), 200, 7});
      }
      const std::string bytes = ToCloud(name, positions, rgb);
      const CloudFile file = Read(name, bytes);
      ASSERT_EQ(file.cloud.size(), positions.size());
      EXPECT_TRUE(file.warnings.empty());
      for (std::size_t i = 0; i < positions.size(); ++i)
        EXPECT_LE((file.cloud.positions[i] - positions[i]).norm(), 1e-4) << name << " " << far_m;
      EXPECT_EQ(file.rgb, rgb) << name;
      const bool doubles =
          bytes.find("SIZE 8 8 8 4\n") != std::string::npos || bytes.find("property double x\n") != std::string::npos;
      const bool text = name.ends_with("csv") || name.ends_with("CSV");
      EXPECT_EQ(doubles, far_m >= 2000.0 && !text) << name << " " << far_m;
    }
}

TEST(ToCloud, IsReadBackWithoutColoursAndEmpty) {
  const std::vector<Eigen::Vector3d> one{{433001.0572, 5614001.1763, 249.976}};
  for (const std::string name : {"a.ply", "a.pcd", "a.csv"}) {
    EXPECT_EQ(Read(name, ToCloud(name, one, {})).cloud.positions, one);
    EXPECT_EQ(Read(name, ToCloud(name, {}, {})).cloud.size(), 0u);
  }
}

}  // namespace
}  // namespace merlin
