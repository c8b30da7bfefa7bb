#include "scenarios/judge/writers.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "robot/base/error.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

using namespace std::string_literals;

TEST(ToTum, WritesNineDecimalsAndTheQuaternionLast) {
  const Trajectory trajectory{
      {Time(0), Pose::Identity()},
      {Time(61'050'000'001), FromXyYaw(1.5, -2.25, std::numbers::pi / 2)},
  };
  EXPECT_EQ(ToTum(trajectory),
            "0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 1.000000000\n"
            "61.050000001 1.500000000 -2.250000000 0.000000000 0.000000000 0.000000000 0.707106781 0.707106781\n");
  EXPECT_EQ(ToTum({}), "");
  EXPECT_TRUE(ToTum({{Time(-1), Pose::Identity()}}).starts_with("-0.000000001 "));
}

TEST(ToTum, KeepsTheScalarPositive) {
  // 350 degrees: the quaternion of half that angle has a negative scalar; its negative is the same rotation.
  const double half_rad = 175.0 * std::numbers::pi / 180.0;
  const Pose pose(Eigen::Quaterniond(std::cos(half_rad), 0, 0, std::sin(half_rad)));
  EXPECT_TRUE(ToTum({{Time(0), pose}}).ends_with("-0.087155743 0.996194698\n"));
}

TEST(ToPly, IsAHeaderAndFifteenBytesAPoint) {
  const std::vector<MapPoint> map{{{1.0f, -2.0f, 0.5f}, {10, 20, 30}}, {{0.0f, 0.0f, 0.0f}, {255, 0, 1}}};
  const std::string ply = ToPly(map);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  ASSERT_EQ(ply.size(), header.size() + 2 * 15);
  EXPECT_EQ(ply.substr(0, header.size()), header);
  // 1.0f = 0x3f800000, -2.0f = 0xc0000000, 0.5f = 0x3f000000
  const char expected[] = "\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x0a\x14\x1e";
  EXPECT_EQ(std::memcmp(ply.data() + header.size(), expected, 15), 0);
  EXPECT_TRUE(ply.ends_with("\xff\x00\x01"s));
  EXPECT_NE(ToPly({}).find("element vertex 0\n"), std::string::npos);
}

TEST(ToPgm, PutsTheHighestYFirst) {
  const GridMap grid{
      .width = 2, .height = 3, .resolution_m = 0.1, .origin_m = {-1, -2}, .cells = {0, 100, -1, 0, 65, 50}};
  EXPECT_EQ(ToPgm(grid), "P5\n2 3\n255\n\x00\xcd\xcd\xfe\xfe\x00"s);
  EXPECT_EQ(ToPgm({}), "P5\n0 0\n255\n");
}

TEST(ToMapYaml, NamesThePictureAndItsPlace) {
  const GridMap grid{.width = 1, .height = 1, .resolution_m = 0.05, .origin_m = {-13.25, 2.5}, .cells = {0}};
  EXPECT_EQ(ToMapYaml(grid, "map.pgm"),
            "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-13.250000, 2.500000, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(ToPgm, IsReadBackAsItWasByTheRuleOfNav2) {
  const GridMap grid{.width = 3, .height = 1, .cells = {0, -1, 100}};
  const std::string pgm = ToPgm(grid);
  std::vector<int> read;
  for (const char grey : pgm.substr(pgm.size() - 3)) {
    const double occupied = (255 - static_cast<unsigned char>(grey)) / 255.0;  // nav2_map_server, map_io, negate 0
    read.push_back(occupied > 0.65 ? 100 : occupied < 0.196 ? 0 : -1);
  }
  EXPECT_EQ(read, (std::vector<int>{0, -1, 100}));
}

TEST(WriteFile, WritesAllBytesAndReplacesAnOlderFile) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\xff", 4), large(3'000'000, 'x');
  WriteFile(folder.path() / "f", large);
  EXPECT_EQ(Contents(folder.path() / "f"), large);
  WriteFile(folder.path() / "f", bytes);
  EXPECT_EQ(Contents(folder.path() / "f"), bytes);
  WriteFile(folder.path() / "f", "");
  EXPECT_EQ(Contents(folder.path() / "f"), "");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, LeavesTheOlderFileWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here to stand for a full disk";
  const TemporaryFolder folder;
  WriteFile(folder.path() / "f", "before");
  std::filesystem::create_symlink("/dev/full", folder.path() / "f.part");
  try {
    WriteFile(folder.path() / "f", "after");
    FAIL() << "a full disk went unnoticed";
  } catch (const MachineError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left on device"), std::string::npos) << error.what();
  }
  EXPECT_EQ(Contents(folder.path() / "f"), "before");
  EXPECT_FALSE(std::filesystem::is_symlink(folder.path() / "f.part"));
}

TEST(WriteFile, ThrowsWhereThereIsNoFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(WriteFile(folder.path() / "none" / "f", "x"), MachineError);
  std::filesystem::create_directory(folder.path() / "d");
  EXPECT_THROW(WriteFile(folder.path() / "d", "x"), MachineError);  // a folder has that name
}

}  // namespace
}  // namespace merlin
