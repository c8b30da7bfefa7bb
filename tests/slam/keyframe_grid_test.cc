#include "slam/map/keyframe_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace merlin {
namespace {

constexpr Footprint kCar{.front_m = 0.45, .rear_m = 0.1, .half_width_m = 0.15, .height_m = 0.3};

// A few points of walls all around, another few for each index.
Keyframe KeyframeAt(std::size_t index, const Pose& T_map_base) {
  std::mt19937 random(static_cast<std::uint32_t>(index));
  std::uniform_real_distribution<float> at(-3.0f, 3.0f);
  Keyframe keyframe;
  keyframe.T_map_base = T_map_base;
  keyframe.camera_base = {0.3f, 0.0f, 0.35f};
  for (int i = 0; i < 8; ++i)
    keyframe.points_base.push_back({.position = {at(random), at(random), 0.4f}, .sigma_m = 0.01f});
  return keyframe;
}

Pose Along(std::size_t index, double turn_rad) {
  return FromXyYaw(0, 0, turn_rad) * FromXyYaw(0.1 * static_cast<double>(index), 0.0, 0.0);
}

// Origin, size and every cell, in the numbers of the map file.
std::vector<double> CellsOf(const OccupancyGrid& grid) {
  std::vector<double> cells{grid.origin_m().x(), grid.origin_m().y(), static_cast<double>(grid.width())};
  for (int row = 0; row < grid.height(); ++row)
    for (int column = 0; column < grid.width(); ++column) cells.push_back(static_cast<double>(grid.At(column, row)));
  return cells;
}

// Enters one key frame after the other directly into a grid.
std::vector<double> MadeAtOnce(const std::vector<Keyframe>& keyframes) {
  OccupancyGrid grid({});
  for (const Keyframe& keyframe : keyframes) {
    grid.Insert(keyframe.points_base, keyframe.camera_base, keyframe.T_map_base);
    grid.Cover(kCar, keyframe.T_map_base);
  }
  return CellsOf(grid);
}

// A grid and its key frames, as Slam drives them.
struct GridDrive {
  void Add(double turn_rad = 0.0) {
    keyframes.push_back(KeyframeAt(keyframes.size(), Along(keyframes.size(), turn_rad)));
    grid.Add(keyframes.back());
  }
  void Move(double turn_rad) {
    for (std::size_t i = 0; i < keyframes.size(); ++i) keyframes[i].T_map_base = Along(i, turn_rad);
    grid.Renew();
  }
  // Number of frames until the grid is renewed, with a new key frame before each if requested.
  std::size_t FramesUntilRenewed(bool drives, double turn_rad) {
    std::size_t frames = 0;
    for (; grid.renewing() && frames < 1000; ++frames) {
      if (drives) Add(turn_rad);
      grid.Follow(keyframes);
    }
    return frames;
  }
  std::vector<Keyframe> keyframes;
  KeyframeGrid grid{OccupancyConfig{}, kCar};
};

TEST(KeyframeGrid, EntersANewKeyFrameAtOnce) {
  GridDrive drive;
  EXPECT_EQ(drive.grid.grid().width(), 0);
  for (int i = 0; i < 3; ++i) {
    drive.Add();
    EXPECT_EQ(CellsOf(drive.grid.grid()), MadeAtOnce(drive.keyframes));
    drive.grid.Follow(drive.keyframes);
    EXPECT_EQ(CellsOf(drive.grid.grid()), MadeAtOnce(drive.keyframes));
  }
}

TEST(KeyframeGrid, IsAsIfMadeAtOnceAfterFortyFramesAtMost) {
  for (const std::size_t count : {0u, 1u, 2u, 39u, 40u, 41u, 79u, 80u, 81u, 300u})
    for (const bool drives : {false, true}) {
      GridDrive drive;
      while (drive.keyframes.size() < count) drive.Add();
      drive.Move(0.1);
      EXPECT_LE(drive.FramesUntilRenewed(drives, 0.1), KeyframeGrid::kFrames)
          << count << " key frames, drives: " << drives;
      EXPECT_EQ(CellsOf(drive.grid.grid()), MadeAtOnce(drive.keyframes)) << count << " key frames, drives: " << drives;
      EXPECT_EQ(CellsOf(GridOf(drive.keyframes, {}, kCar)), MadeAtOnce(drive.keyframes));
    }
}

TEST(KeyframeGrid, EntersFewKeyFramesAtAFrame) {
  GridDrive drive;
  while (drive.keyframes.size() < 400) drive.Add();
  drive.Move(0.1);
  EXPECT_GE(drive.FramesUntilRenewed(false, 0.1), 400u / (400u / KeyframeGrid::kFrames + 2));
}

TEST(KeyframeGrid, ShowsTheFormerGridAndWhatIsNewUntilItIsRenewed) {
  GridDrive drive;
  while (drive.keyframes.size() < 200) drive.Add();
  std::vector<Keyframe> seen = drive.keyframes;
  drive.Move(0.5);
  for (int frame = 0; frame < 5; ++frame) {
    drive.Add(0.5);
    seen.push_back(drive.keyframes.back());
    drive.grid.Follow(drive.keyframes);
    ASSERT_TRUE(drive.grid.renewing());
    EXPECT_EQ(CellsOf(drive.grid.grid()), MadeAtOnce(seen));
  }
}

TEST(KeyframeGrid, FollowsASecondCorrectionThatComesBeforeTheFirstIsThrough) {
  for (const int between : {0, 1, 20, 38, 39, 40}) {
    GridDrive drive;
    while (drive.keyframes.size() < 300) drive.Add();
    drive.Move(0.1);
    for (int frame = 0; frame < between; ++frame) drive.grid.Follow(drive.keyframes);
    drive.Move(0.2);
    EXPECT_LE(drive.FramesUntilRenewed(true, 0.2), 2 * KeyframeGrid::kFrames) << between;
    EXPECT_EQ(CellsOf(drive.grid.grid()), MadeAtOnce(drive.keyframes)) << between;
  }
}

// If each correction started the renewal again, it would never end.
TEST(KeyframeGrid, IsRenewedThoughCorrectionsNeverEnd) {
  GridDrive drive;
  while (drive.keyframes.size() < 300) drive.Add();
  const std::vector<double> before = CellsOf(drive.grid.grid());
  for (std::size_t frame = 0; frame < KeyframeGrid::kFrames; ++frame) {
    drive.Move(0.001 * static_cast<double>(frame + 1));
    drive.grid.Follow(drive.keyframes);
  }
  EXPECT_NE(CellsOf(drive.grid.grid()), before);
}

TEST(KeyframeGrid, IsACopyableStateThatGoesOnAlike) {
  GridDrive drive;
  while (drive.keyframes.size() < 100) drive.Add();
  drive.Move(0.1);
  drive.grid.Follow(drive.keyframes);
  GridDrive copy = drive;
  EXPECT_EQ(copy.FramesUntilRenewed(true, 0.1), drive.FramesUntilRenewed(true, 0.1));
  EXPECT_EQ(CellsOf(copy.grid.grid()), CellsOf(drive.grid.grid()));
}

}  // namespace
}  // namespace merlin
