#include "slam/map/moved_away.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace merlin {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kCamera_m = 0.35;  // height
constexpr double kFar_m = 6.0;      // beyond it nothing returns

// Along a ray from outside to the box; infinite: past it. Slabs, one axis after the other.
double RangeTo(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double enter = 0.0, leave = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min()[axis] - origin[axis]) / direction[axis], b = (box.max()[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : HUGE_VAL;
}

// Frames from a 64 x 48 camera of 40 x 30 deg, 1 cm of noise along the rays.
class Camera {
 public:
  Keyframe Look(const std::vector<Box>& world, const Pose& T_map_base, bool tells_free) {
    Keyframe keyframe;
    keyframe.T_map_base = T_map_base;
    keyframe.camera_base = {0.0f, 0.0f, kCamera_m};
    std::vector<Eigen::Vector3f> free_base;
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 64; ++u) {
        const Eigen::Vector3d ray = Eigen::Vector3d(1.0, (31.5 - u) * 0.01137, (23.5 - v) * 0.01116).normalized();
        const Eigen::Vector3d from_map = T_map_base * Eigen::Vector3d(0.0, 0.0, kCamera_m), ray_map = T_map_base.linear() * ray;
        double range_m = HUGE_VAL;
        for (const Box& box : world) range_m = std::min(range_m, RangeTo(box, from_map, ray_map));
        const Eigen::Vector3d end = Eigen::Vector3d(0.0, 0.0, kCamera_m) + ray * (range_m < kFar_m ? range_m + noise_(random_) : 4.0);
        if (range_m < kFar_m) keyframe.points_base.push_back({.position = end.cast<float>(), .sigma_m = 0.01f});
        else if (tells_free) free_base.push_back(end.cast<float>());
      }
    keyframe.sights = {{.view = ClearView(keyframe.points_base, free_base, keyframe.camera_base)}};
    return keyframe;
  }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0.0, 0.01};
};

// Two walls 2 m apart, a floor, and maybe an end.
std::vector<Box> Corridor(double end_m) {
  const auto box = [](double x0, double y0, double z0, double x1, double y1, double z1) {
    return Box(Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1));
  };
  return {box(-9, 1, 0, 99, 2, 3), box(-9, -2, 0, 99, -1, 3), box(-9, -2, -1, 99, 2, 0), box(end_m, -2, 0, end_m + 1, 2, 3)};
}

const Box kBox(Eigen::Vector3d(3.0, -0.2, 0.0), Eigen::Vector3d(3.4, 0.2, 0.5));

struct Outcome {
  int box = 0, rest = 0;            // voxels
  int box_left = 0, rest_left = 0;  // that did not move away
};

// Thirty frames 5 cm apart towards the box, which is there in those that is_there names.
Outcome Drive(double end_m, bool tells_free, const std::function<bool(int)>& is_there, const Box& thing = kBox) {
  Camera camera;
  std::vector<Keyframe> keyframes;
  VoxelMap map({.voxel_m = 0.04});
  for (int i = 0; i < 30; ++i) {
    std::vector<Box> world = Corridor(end_m);
    if (is_there(i)) world.push_back(thing);
    keyframes.push_back(camera.Look(world, FromXyYaw(0.05 * i, 0.02 * std::sin(i), 0.03 * std::sin(0.7 * i)), tells_free));
    map.Insert(keyframes.back().points_base, keyframes.back().T_map_base, 0.0);
  }
  const std::vector<bool> gone = MovedAway(map.voxels(), keyframes, {});
  const Box around(thing.min() - Eigen::Vector3d(0.06, 0.06, -0.06), thing.max() + Eigen::Vector3d(0.06, 0.06, 0.06));  // off the floor
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
    const Outcome out = Drive(5.0, false, [&](int i) { return i >= first && i < first + 5; });
    EXPECT_GT(out.box, 100);
    EXPECT_LE(out.box_left, out.box / 50) << "from frame " << first;
    EXPECT_GE(out.rest_left, 0.99 * out.rest);
  }
}

TEST(MovedAway, TakesOutABoxThatStoodLongAndThenWentAway) {
  const Outcome out = Drive(5.0, false, [](int i) { return i < 25; });
  EXPECT_GT(out.box, 100);
  EXPECT_LE(out.box_left, out.box / 20);
  EXPECT_GE(out.rest_left, 0.99 * out.rest);
}

TEST(MovedAway, KeepsABoxThatCameAndStayed) {
  for (const int first : {0, 10, 20}) {
    const Outcome out = Drive(5.0, false, [&](int i) { return i >= first; });
    EXPECT_GE(out.box_left, 0.99 * out.box) << "from frame " << first;
    EXPECT_GE(out.rest_left, 0.99 * out.rest);
  }
}

TEST(MovedAway, KeepsAThinPole) {
  const Outcome out = Drive(5.0, false, [](int) { return true; }, Box(Eigen::Vector3d(3.0, -0.02, 0.0), Eigen::Vector3d(3.04, 0.02, 0.9)));
  EXPECT_GT(out.box, 30);
  EXPECT_GE(out.box_left, 0.95 * out.box);
}

// A corridor's end beyond the camera's range proves nothing, unless the camera says that its rays were free.
TEST(MovedAway, NeedsRaysThatTellOfTheDark) {
  const auto passes_by = [](int i) { return i >= 12 && i < 17; };
  const Outcome silent = Drive(90.0, false, passes_by), told = Drive(90.0, true, passes_by);
  EXPECT_GT(silent.box_left, silent.box / 4);
  EXPECT_LE(told.box_left, told.box / 50);
  EXPECT_GE(told.rest_left, 0.99 * told.rest);
}

// Points on a line across the way, 2 cm apart and 12 cm above the floor, and one on the floor; the car drives over them.
TEST(MovedAway, TakesOutWhatStoodWhereTheCarDrove) {
  std::vector<Point> line;
  for (int i = -10; i <= 10; ++i) line.push_back({.position = {1.0f, 0.02f * i + 0.01f, 0.12f}, .sigma_m = 0.01f});
  line.push_back({.position = {1.0f, 0.01f, 0.01f}, .sigma_m = 0.01f});
  VoxelMap map({.voxel_m = 0.02});
  map.Insert(line, Pose::Identity(), 0.0);
  std::vector<Keyframe> keyframes(12);
  for (int i = 0; i < 12; ++i) keyframes[i].T_map_base = FromXyYaw(0.1 * i, 0.0, 0.0);
  const Footprint footprint{.front_m = 0.4, .half_width_m = 0.105, .height_m = 0.2};
  const auto left_of = [&](std::span<const Keyframe> driven) {
    const std::vector<bool> gone = MovedAway(map.voxels(), driven, footprint);
    std::vector<float> left;
    for (std::size_t i = 0; i < gone.size(); ++i)
      if (!gone[i]) left.push_back(map.voxels()[i].mean.y());
    return left;
  };
  EXPECT_EQ(left_of(std::span(keyframes).first(6)).size(), 22u);  // its front stands at 0.9 m
  const std::vector<float> left = left_of(keyframes);
  EXPECT_EQ(left.size(), 11u + 1u);  // 21 less the ten within 10.5 cm, and the one on the floor
  EXPECT_EQ(std::ranges::count_if(left, [](float y) { return std::abs(y) > 0.105f; }), 11);
}

TEST(MovedAway, TakesNothingFromNothing) {
  EXPECT_TRUE(MovedAway({}, {}, {}).empty());
  VoxelMap map({});
  map.Insert(std::vector<Point>{{.position = {1.0f, 0.0f, 0.0f}, .sigma_m = 0.01f}}, Pose::Identity(), 0.0);
  EXPECT_EQ(MovedAway(map.voxels(), {}, {}), std::vector<bool>{false});
  const std::vector<Keyframe> blind(5, Keyframe{});
  EXPECT_EQ(MovedAway(map.voxels(), blind, {}), std::vector<bool>{false});
}

using enum ClearView::Look;

TEST(ClearView, TellsWhatIsThereFromWhatWasLookedThrough) {
  // A wall 2 m ahead of a camera at (0.3, 0, 0.35): 21 x 21 rays to a square of 2 m.
  std::vector<Point> wall;
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j) wall.push_back({.position = {2.3f, 0.1f * i, 0.35f + 0.1f * j}});
  const ClearView view(wall, {}, {0.3f, 0.0f, 0.35f});
  EXPECT_EQ(view.At({1.3f, 0.0f, 0.35f}), kThrough);
  EXPECT_EQ(view.At({2.25f, 0.3f, 0.1f}), kThere);
  EXPECT_EQ(view.At({2.35f, 0.3f, 0.1f}), kThere);
  EXPECT_EQ(view.At({3.3f, 0.0f, 0.35f}), kNone);   // behind the wall
  EXPECT_EQ(view.At({1.3f, 0.7f, 0.35f}), kNone);   // beside the view
  EXPECT_EQ(view.At({-0.7f, 0.0f, 0.35f}), kNone);  // behind the camera
  EXPECT_EQ(view.At({std::nanf(""), 0.0f, 0.35f}), kNone);
  EXPECT_NEAR(view.reach_m(), std::sqrt(4.0f + 1.0f + 1.0f), 1e-5f);
}

TEST(ClearView, FollowsACameraThatIsTurned) {
  const Pose T = FromXyYaw(1.0, 2.0, 2.5);
  std::vector<Point> wall;
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j) wall.push_back({.position = (T * Eigen::Vector3d(2.0, 0.1 * i, 0.1 * j)).cast<float>()});
  const ClearView view(wall, {}, T.translation().cast<float>());
  EXPECT_EQ(view.At((T * Eigen::Vector3d(1.0, 0.2, 0.3)).cast<float>()), kThrough);
  EXPECT_EQ(view.At((T * Eigen::Vector3d(2.0, 0.5, -0.3)).cast<float>()), kThere);
  EXPECT_EQ(view.At((T * Eigen::Vector3d(1.0, -0.7, 0.0)).cast<float>()), kNone);
}

TEST(ClearView, LetsTheShortestRayOfAPlaceDecide) {
  std::vector<Point> points{{.position = {3.0f, 0.0f, 0.0f}}, {.position = {1.0f, 0.0f, 0.0f}}, {.position = {3.0f, 0.0f, 0.0f}}};
  EXPECT_EQ(ClearView(points, {}, Eigen::Vector3f::Zero()).At({2.0f, 0.0f, 0.0f}), kNone);
  points.erase(points.begin() + 1);
  EXPECT_EQ(ClearView(points, {}, Eigen::Vector3f::Zero()).At({2.0f, 0.0f, 0.0f}), kThrough);
}

TEST(ClearView, SaysNothingOfNothing) {
  const std::vector<Point> none, bad{{.position = {std::nanf(""), 0.0f, 0.0f}}, {.position = {HUGE_VALF, 0.0f, 0.0f}}};
  std::vector<Point> around;  // all directions: no middle
  for (int i = 0; i < 360; ++i)
    around.push_back({.position = {2.0f * std::cos(0.0174533f * i), 2.0f * std::sin(0.0174533f * i), 0.0f}});
  for (const auto& points : {none, bad, around}) {
    const ClearView view(points, {}, Eigen::Vector3f::Zero());
    EXPECT_EQ(view.At({1.0f, 0.0f, 0.0f}), kNone);
    EXPECT_EQ(view.At({0.0f, 0.0f, 0.0f}), kNone);
  }
  EXPECT_EQ(ClearView().At({1.0f, 0.0f, 0.0f}), kNone);
  // One ray alone, and one of no length.
  const std::vector<Point> one{{.position = {2.0f, 0.0f, 0.0f}}, {.position = {0.0f, 0.0f, 0.0f}}};
  EXPECT_EQ(ClearView(one, {}, Eigen::Vector3f::Zero()).At({1.0f, 0.0f, 0.0f}), kThrough);
}

}  // namespace
}  // namespace merlin
