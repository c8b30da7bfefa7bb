#include "slam/map/moved_away.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "slam/slam.h"

namespace merlin {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kCamera_m = 0.35;  // height
constexpr double kFar_m = 6.0;      // nothing returns from beyond it...
constexpr double kFree_m = 4.0;     // ...and the path is then free up to here

// Distance along a ray from outside to the box; infinite if the ray misses it. Slab method, one axis after the other,
// in plain numbers, because it is called a million times, under the sanitizers too.
double RangeTo(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double *low = box.min().data(), *high = box.max().data(), *from = origin.data(), *along = direction.data();
  double enter = 0.0, leave = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - from[axis]) / along[axis], b = (high[axis] - from[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : HUGE_VAL;
}

// Frames from a 64 x 48 camera of 40 x 30 deg, 1 cm of noise along the rays.
class Camera {
 public:
  Camera() {
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 64; ++u)
        rays_.push_back(Eigen::Vector3d(1.0, (31.5 - u) * 0.01137, (23.5 - v) * 0.01116).normalized());
  }
  Observation See(const std::vector<Box>& world, const Pose& T_map_base, bool tells_free) {
    Observation seen;
    seen.stamp = FromSeconds(seconds_++);
    seen.camera_base = {0.0f, 0.0f, kCamera_m};
    const Eigen::Vector3d camera = seen.camera_base.cast<double>(), from_map = T_map_base * camera;
    for (const Eigen::Vector3d& ray : rays_) {
      const Eigen::Vector3d ray_map = T_map_base.linear() * ray;
      double range_m = HUGE_VAL;
      for (const Box& box : world) range_m = std::min(range_m, RangeTo(box, from_map, ray_map));
      const Eigen::Vector3d end = camera + ray * (range_m < kFar_m ? range_m + noise_(random_) : kFree_m);
      if (range_m < kFar_m)
        seen.points_base.push_back({.position = end.cast<float>(), .sigma_m = 0.01f});
      else if (tells_free)
        seen.free_base.push_back(end.cast<float>());
      else
        seen.unknown_base.push_back(ray.cast<float>());
    }
    return seen;
  }
  Keyframe Look(const std::vector<Box>& world, const Pose& T_map_base, bool tells_free) {
    const Observation seen = See(world, T_map_base, tells_free);
    Keyframe keyframe;
    keyframe.T_map_base = T_map_base;
    keyframe.points_base = seen.points_base;
    keyframe.views = {{seen.stamp, Pose::Identity(), ClearView(seen)}};
    return keyframe;
  }

 private:
  std::vector<Eigen::Vector3d> rays_;
  int seconds_ = 0;
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0.0, 0.01};
};

// Two walls 2 m apart, a floor, and maybe an end.
std::vector<Box> BoxCorridor(double end_m) {
  const auto box = [](double x0, double y0, double z0, double x1, double y1, double z1) {
    return Box(Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1));
  };
  return {box(-9, 1, 0, 99, 2, 3), box(-9, -2, 0, 99, -1, 3), box(-9, -2, -1, 99, 2, 0),
          box(end_m, -2, 0, end_m + 1, 2, 3)};
}

const Box kBox(Eigen::Vector3d(3.0, -0.2, 0.0), Eigen::Vector3d(3.4, 0.2, 0.5));

struct Outcome {
  int box = 0, rest = 0;            // voxels
  int box_left = 0, rest_left = 0;  // that did not move away
};

// Thirty frames 5 cm apart towards the box, which is present in those that is_there selects.
Outcome DrivePast(double end_m, bool tells_free, const std::function<bool(int)>& is_there, const Box& thing = kBox) {
  Camera camera;
  std::vector<Keyframe> keyframes;
  VoxelMap map({.voxel_m = 0.04});
  for (int i = 0; i < 30; ++i) {
    std::vector<Box> world = BoxCorridor(end_m);
    if (is_there(i)) world.push_back(thing);
    keyframes.push_back(
        camera.Look(world, FromXyYaw(0.05 * i, 0.02 * std::sin(i), 0.03 * std::sin(0.7 * i)), tells_free));
    map.Insert(keyframes.back().points_base, keyframes.back().T_map_base, 0.0);
  }
  const std::vector<bool> gone = MovedAway(map.voxels(), keyframes, {});
  // Lower down the floor behind is too near to tell a ray through the thing from one that meets it.
  const Box around(thing.min() + Eigen::Vector3d(-0.06, -0.06, 0.1), thing.max() + Eigen::Vector3d(0.06, 0.06, 0.06));
  Outcome out;
  for (std::size_t i = 0; i < gone.size(); ++i) {
    const bool in_box = around.contains(map.voxels()[i].mean.cast<double>());
    ++(in_box ? out.box : out.rest);
    if (!gone[i]) ++(in_box ? out.box_left : out.rest_left);
  }
  EXPECT_GT(out.rest, 3000);
  return out;
}

TEST(MovedAway, TakesOutABoxThatStoodInFiveOfThirtyFrames) {
  for (const int first : {0, 12, 22}) {
    const Outcome out = DrivePast(5.0, false, [&](int i) { return i >= first && i < first + 5; });
    EXPECT_GT(out.box, 100);
    EXPECT_EQ(out.box_left, 0) << "from frame " << first;
    EXPECT_GE(out.rest_left, 0.99 * out.rest);
  }
}

TEST(MovedAway, TakesOutABoxThatStoodLongAndThenWentAway) {
  const Outcome out = DrivePast(5.0, false, [](int i) { return i < 25; });
  EXPECT_GT(out.box, 100);
  EXPECT_EQ(out.box_left, 0);
  EXPECT_GE(out.rest_left, 0.99 * out.rest);
}

TEST(MovedAway, KeepsABoxThatCameAndStayed) {
  for (const int first : {0, 10, 20}) {
    const Outcome out = DrivePast(5.0, false, [&](int i) { return i >= first; });
    EXPECT_GE(out.box_left, 0.99 * out.box) << "from frame " << first;
    EXPECT_GE(out.rest_left, 0.99 * out.rest);
  }
}

TEST(MovedAway, KeepsAThinPole) {
  const Outcome out = DrivePast(
      5.0, false, [](int) { return true; }, Box(Eigen::Vector3d(3.0, -0.02, 0.0), Eigen::Vector3d(3.04, 0.02, 0.9)));
  EXPECT_GT(out.box, 30);
  EXPECT_GE(out.box_left, 0.95 * out.box);
}

// The end of a corridor beyond the camera's range proves nothing, unless the camera reports that its rays were free.
TEST(MovedAway, NeedsRaysThatTellOfTheDark) {
  const auto passes_by = [](int i) { return i >= 12 && i < 17; };
  const Outcome silent = DrivePast(90.0, false, passes_by), told = DrivePast(90.0, true, passes_by);
  EXPECT_GT(silent.box_left, silent.box / 4);
  EXPECT_EQ(told.box_left, 0);
  EXPECT_GE(told.rest_left, 0.99 * told.rest);
}

// The floor from 3.4 m on, seen from near at first, then as nothing but dark pixels: each implies that it is free for
// longer than the floor is away, since the floor sends so little back.
TEST(MovedAway, KeepsAFloorThatIsTooDarkFromFarAway) {
  VoxelMap map({.voxel_m = 0.04});
  std::vector<Keyframe> keyframes;
  Camera camera;
  for (int i = 0; i < 8; ++i) {
    const bool far = i >= 4;
    keyframes.push_back(camera.Look(BoxCorridor(50.0), FromXyYaw(far ? 0.1 * i : 3.0 + 0.1 * i, 0.0, 0.0), false));
    if (!far) map.Insert(keyframes.back().points_base, keyframes.back().T_map_base, 0.0);
    if (!far) continue;
    Observation dark;
    dark.camera_base = {0.0f, 0.0f, kCamera_m};
    for (const Point& point : keyframes.back().points_base)
      if (point.position.z() < 0.1f)
        dark.free_base.push_back(dark.camera_base + 1.4f * (point.position - dark.camera_base));
    keyframes.back().views[0].view = ClearView(dark);
  }
  const std::vector<bool> gone = MovedAway(map.voxels(), keyframes, {});
  EXPECT_LT(std::ranges::count(gone, true), 0.01 * static_cast<double>(gone.size()));
}

// Two visits whose poses disagree by 5 cm and 10 mrad, and walls along the path.
TEST(MovedAway, KeepsWallsOfTwoVisitsThatDoNotQuiteAgree) {
  VoxelMap map({.voxel_m = 0.04});
  std::vector<Keyframe> keyframes;
  Camera camera;
  for (int i = 0; i < 60; ++i) {
    const Pose T_map_base = FromXyYaw(0.05 * (i % 30), 0.0, 0.0);
    keyframes.push_back(camera.Look(BoxCorridor(5.0), T_map_base, true));
    if (i >= 30) keyframes.back().T_map_base = FromXyYaw(0.0, 0.05, 0.01) * T_map_base;
    if (i < 30) map.Insert(keyframes.back().points_base, keyframes.back().T_map_base, 0.0);
  }
  const std::vector<bool> gone = MovedAway(map.voxels(), keyframes, {});
  EXPECT_LT(std::ranges::count(gone, true), 0.02 * static_cast<double>(gone.size()));
}

// However rarely it was seen, two views through it may be wrong.
TEST(MovedAway, NeedsThreeViewsThroughAVoxel) {
  Camera camera;
  VoxelMap map({.voxel_m = 0.04});
  map.Insert(std::vector<Point>{{.position = {3.0f, 0.02f, 0.5f}, .sigma_m = 0.01f}}, Pose::Identity(), 0.0);
  std::vector<Keyframe> keyframes;
  for (int looks = 1; looks <= 4; ++looks) {
    keyframes.push_back(camera.Look(BoxCorridor(5.0), Pose::Identity(), false));
    EXPECT_EQ(MovedAway(map.voxels(), keyframes, {}), std::vector<bool>{looks >= 3}) << looks;
  }
}

// A pole of one pixel's width, its pixels left out by the filter; the wall behind it is seen on both sides.
TEST(MovedAway, KeepsWhatPixelsThatDoNotTellStandFor) {
  VoxelMap map({.voxel_m = 0.04});
  std::vector<Point> pole;
  for (int i = 0; i < 40; ++i)
    pole.push_back({.position = {3.0f, 0.002f * (i % 5), 0.2f + 0.01f * i}, .sigma_m = 0.01f});
  map.Insert(pole, Pose::Identity(), 0.0);
  for (const bool tells : {false, true}) {
    Observation seen;
    seen.camera_base = {0.0f, 0.0f, kCamera_m};
    for (int v = -24; v < 24; ++v)
      for (int u = -32; u < 32; ++u) {
        const Eigen::Vector3f ray = Eigen::Vector3f(1.0f, 0.011f * u, 0.011f * v).normalized();
        if (u == 0 && !tells)
          seen.unknown_base.push_back(ray);
        else
          seen.points_base.push_back({.position = seen.camera_base + 5.0f * ray});
      }
    std::vector<Keyframe> keyframes(4);
    for (Keyframe& keyframe : keyframes) keyframe.views = {{.view = ClearView(seen)}};
    const std::vector<bool> gone = MovedAway(map.voxels(), keyframes, {});
    EXPECT_EQ(std::ranges::count(gone, true), tells ? std::ssize(gone) : 0);
  }
}

// The same frames as views of one key frame far away, in another order, are the same evidence.
TEST(MovedAway, TakesViewsWhereTheyWereInTheOrderOfTime) {
  Camera camera;
  std::vector<Keyframe> keyframes;
  VoxelMap map({.voxel_m = 0.04});
  for (int i = 0; i < 12; ++i) {
    std::vector<Box> world = BoxCorridor(5.0);
    if (i < 6) world.push_back(kBox);
    keyframes.push_back(camera.Look(world, FromXyYaw(0.05 * i, 0.0, 0.1), false));
    map.Insert(keyframes.back().points_base, keyframes.back().T_map_base, 0.0);
  }
  Keyframe one;
  one.T_map_base = FromXyYaw(-7.0, 3.0, 2.0);
  for (auto keyframe = keyframes.rbegin(); keyframe != keyframes.rend(); ++keyframe) {
    one.views.push_back(keyframe->views[0]);
    one.views.back().T_keyframe_base = one.T_map_base.inverse() * keyframe->T_map_base;
  }
  const std::vector<bool> gone = MovedAway(map.voxels(), keyframes, {});
  EXPECT_GT(std::ranges::count(gone, true), 100);
  const std::vector<bool> of_one = MovedAway(map.voxels(), std::span(&one, 1), {});
  int differ = 0;  // but for the last bit of a pose
  for (std::size_t i = 0; i < gone.size(); ++i) differ += gone[i] != of_one[i];
  EXPECT_LE(differ, 3);
}

// Points on a line across the path, 2 cm apart and 12 cm above the floor, and one on the floor; the car drives over
// them.
TEST(MovedAway, TakesOutWhatStoodWhereTheCarDrove) {
  const Pose T_map_way = FromXyYaw(2.0, -1.0, 2.0);
  std::vector<Point> line;
  const auto add = [&](double left_m, double up_m) {
    line.push_back({.position = (T_map_way * Eigen::Vector3d(1.0, left_m, up_m)).cast<float>(), .sigma_m = 0.01f});
  };
  for (int i = -10; i <= 10; ++i) add(0.02 * i + 0.01, 0.12);
  add(0.01, 0.01);
  VoxelMap map({.voxel_m = 0.005});
  map.Insert(line, Pose::Identity(), 0.0);
  std::vector<Keyframe> keyframes(12);
  for (int i = 0; i < 12; ++i) {
    keyframes[i].T_map_base = T_map_way * FromXyYaw(0.1 * i, 0.0, 0.0);
    keyframes[i].views = {PlacedView{}};
  }
  const Footprint footprint{.front_m = 0.4, .half_width_m = 0.145, .height_m = 0.2};
  const auto left_of = [&](std::span<const Keyframe> driven) {
    const std::vector<bool> gone = MovedAway(map.voxels(), driven, footprint);
    std::vector<double> left;
    for (std::size_t i = 0; i < gone.size(); ++i)
      if (!gone[i]) left.push_back((T_map_way.inverse() * map.voxels()[i].mean.cast<double>()).y());
    return left;
  };
  EXPECT_EQ(left_of(std::span(keyframes).first(9)).size(), 22u);  // its nose is over them, its middle not yet
  const std::vector<double> left = left_of(keyframes);
  EXPECT_EQ(left.size(), 11u + 1u);  // 21 less the ten within 14.5 - 4 cm, and the one on the floor
  EXPECT_EQ(std::ranges::count_if(left, [](double y) { return std::abs(y) > 0.105; }), 11);
}

// The car waits in front of a box that stays or goes: no new key frame is taken, and it keeps few views, however long
// this lasts.
TEST(Slam, TakesOutOfItsMapWhatGoesAwayWhileTheCarStands) {
  for (const bool goes : {false, true}) {
    Slam slam({});
    Camera camera;
    for (int i = 0; i < 40; ++i) {
      std::vector<Box> world = BoxCorridor(5.0);
      if (!goes || i < 20) world.push_back(kBox);
      const double x_m = std::min(0.05 * i, 0.5);
      Observation observation = camera.See(world, FromXyYaw(x_m, 0.0, 0.0), false);
      observation.T_odom_base = FromXyYaw(x_m, 0.0, 0.0);
      observation.yaw_sigma_rad = 0.001;
      ASSERT_TRUE(slam.Update(observation));
      EXPECT_EQ(slam.lost_frames(), 0);
    }
    ASSERT_FALSE(slam.keyframes().empty());
    EXPECT_NEAR(slam.keyframes().back().T_map_base.translation().x(), 0.5, 0.1);
    EXPECT_EQ(slam.keyframes().back().views.size(), 4u);
    const VoxelMap map = slam.BuildMap();
    const Box front(Eigen::Vector3d(2.9, -0.2, 0.15), Eigen::Vector3d(3.1, 0.2, 0.5));
    const auto in_front = [&](const Voxel& voxel) { return front.contains(voxel.mean.cast<double>()); };
    const auto left = std::ranges::count_if(map.voxels(), in_front);
    EXPECT_TRUE(goes ? left == 0 : left > 80) << left;  // of 4 cm: 0.35 x 0.4 m are 88
  }
}

TEST(MovedAway, AcceptsAnEmptyMap) {
  EXPECT_TRUE(MovedAway({}, {}, {}).empty());
  VoxelMap map({});
  map.Insert(std::vector<Point>{{.position = {1.0f, 0.0f, 0.0f}, .sigma_m = 0.01f}}, Pose::Identity(), 0.0);
  EXPECT_EQ(MovedAway(map.voxels(), {}, {}), std::vector<bool>{false});
  std::vector<Keyframe> blind(5);
  for (Keyframe& keyframe : blind) keyframe.views = {PlacedView{}};
  EXPECT_EQ(MovedAway(map.voxels(), blind, {}), std::vector<bool>{false});
}

}  // namespace
}  // namespace merlin
