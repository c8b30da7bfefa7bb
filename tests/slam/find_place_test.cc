#include "slam/loop/find_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace merlin {
namespace {

struct PlanWall {
  double x0, y0, x1, y1;
};

// A ring of corridors around a block of 10 m x 6 m, with cupboards of different sizes.
std::vector<PlanWall> RingWalls() {
  std::vector<PlanWall> walls{{0, 0, 14, 0}, {14, 0, 14, 10}, {14, 10, 0, 10}, {0, 10, 0, 0},
                              {2, 2, 12, 2}, {12, 2, 12, 8},  {12, 8, 2, 8},   {2, 8, 2, 2}};
  struct Cupboard {
    double x, y;          // a corner on the wall
    double dx, dy;        // its edge along the wall...
    double out_x, out_y;  // ...and away from it
  };
  for (const Cupboard& c :
       {Cupboard{2.8, 0, 0.3, 0, 0, 0.5}, Cupboard{4.6, 0, 1.1, 0, 0, 0.3}, Cupboard{8.9, 2, 0.7, 0, 0, -0.6},
        Cupboard{11.0, 0, 0.5, 0, 0, 0.2}, Cupboard{14, 3.5, 0, 0.9, -0.5, 0}, Cupboard{12, 5.6, 0, 0.3, 0.7, 0},
        Cupboard{14, 7.3, 0, 0.5, -0.3, 0}, Cupboard{4.3, 10, 0.9, 0, 0, -0.6}, Cupboard{6.2, 8, 0.3, 0, 0, 0.4},
        Cupboard{9.5, 10, 0.4, 0, 0, -0.3}, Cupboard{0, 4.1, 0, 1.3, 0.4, 0}, Cupboard{2, 6.4, 0, 0.6, -0.3, 0}}) {
    const double x1 = c.x + c.dx, y1 = c.y + c.dy;
    walls.insert(walls.end(), {{c.x, c.y, c.x + c.out_x, c.y + c.out_y},
                               {c.x + c.out_x, c.y + c.out_y, x1 + c.out_x, y1 + c.out_y},
                               {x1 + c.out_x, y1 + c.out_y, x1, y1}});
  }
  return walls;
}

// Where a ray from here first meets a wall; by intersection of two lines.
double RayLength_m(const std::vector<PlanWall>& walls, const Eigen::Vector2d& from, const Eigen::Vector2d& along) {
  double range_m = HUGE_VAL;
  for (const PlanWall& wall : walls) {
    const Eigen::Vector2d a(wall.x0, wall.y0), edge = Eigen::Vector2d(wall.x1, wall.y1) - a, to = a - from;
    const double cross = along.x() * edge.y() - along.y() * edge.x();
    if (std::abs(cross) < 1e-9) continue;
    const double t = (to.x() * edge.y() - to.y() * edge.x()) / cross;
    const double s = (to.x() * along.y() - to.y() * along.x()) / cross;
    if (t > 1e-6 && s >= 0.0 && s <= 1.0) range_m = std::min(range_m, t);
  }
  return range_m;
}

// What a camera of 90 deg sees up to 6 m, and the floor before it.
std::vector<Point> ViewIn(const std::vector<PlanWall>& walls, const Pose& T_map_base) {
  std::vector<Point> points;
  const Eigen::Vector2d from = T_map_base.translation().head<2>();
  for (int i = -90; i <= 90; ++i) {
    const double angle_rad = i * 0.25 * std::numbers::pi / 90.0, yaw_rad = Yaw(T_map_base) + angle_rad;
    const double range_m = RayLength_m(walls, from, {std::cos(yaw_rad), std::sin(yaw_rad)});
    const Eigen::Vector2f ray = Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)).cast<float>();
    if (range_m < 6.0)
      for (float z = 0.1f; z < 1.0f; z += 0.1f) {
        const Eigen::Vector2f p = static_cast<float>(range_m) * ray;
        points.push_back({.position = {p.x(), p.y(), z}, .sigma_m = 0.01f});
      }
    for (float r = 0.6f; r < std::min(range_m, 3.0); r += 0.3f)
      points.push_back({.position = {r * ray.x(), r * ray.y(), 0.0f}, .sigma_m = 0.01f});
  }
  return points;
}

Keyframe KeyframeIn(const std::vector<PlanWall>& walls, const Pose& pose, double path_m) {
  Keyframe keyframe;
  keyframe.T_map_base = pose;
  keyframe.path_m = path_m;
  keyframe.points_base = ViewIn(walls, pose);
  keyframe.camera_base = {0.0f, 0.0f, 0.4f};
  return keyframe;
}

// Once around, in the middle of the corridors.
std::vector<Keyframe> LapIn(const std::vector<PlanWall>& walls) {
  std::vector<Keyframe> keyframes;
  const Eigen::Vector2d corners[] = {{1, 1}, {13, 1}, {13, 9}, {1, 9}, {1, 1}};
  double path_m = 0.0;
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d way = corners[side + 1] - corners[side];
    for (double s = 0.0; s < way.norm(); s += 0.25, path_m += 0.25) {
      const Eigen::Vector2d p = corners[side] + s * way.normalized();
      keyframes.push_back(KeyframeIn(walls, FromXyYaw(p.x(), p.y(), std::atan2(way.y(), way.x())), path_m));
    }
  }
  return keyframes;
}

// What was seen over the last three metres, in the frame of the last pose.
std::vector<Point> SeenIn(const std::vector<PlanWall>& walls, const Pose& T_map_base) {
  std::vector<Point> points;
  for (double back_m = 0.0; back_m <= 3.0; back_m += 0.5) {
    const Pose T_base_then = FromXyYaw(-back_m, 0.0, 0.0);
    for (Point point : ViewIn(walls, T_map_base * T_base_then)) {
      point.position = T_base_then.cast<float>() * point.position;
      points.push_back(point);
    }
  }
  return Downsample(points, 0.08);
}

TEST(PlaceFinder, KnowsThePlaceOnEverySideOfARingWithoutAnyGuess) {
  const auto walls = RingWalls();
  const auto keyframes = LapIn(walls);
  const PlaceFinder finder(keyframes, {}, {});
  for (const Pose& truth : {FromXyYaw(5.1, 1.1, 0.05), FromXyYaw(13.1, 3.6, 1.5), FromXyYaw(8.0, 8.9, 3.1),
                            FromXyYaw(1.1, 7.9, -1.6), FromXyYaw(10.0, 1.0, 0.0)}) {
    const PlaceFound search = finder.Find(keyframes, SeenIn(walls, truth));
    ASSERT_TRUE(search.place) << truth.translation().transpose() << ": " << search.fitting << " fitting";
    EXPECT_LT((search.place->T_map_base.translation() - truth.translation()).norm(), 0.03);
    EXPECT_NEAR(WrapPi(Yaw(search.place->T_map_base) - Yaw(truth)), 0.0, 0.01);
  }
}

TEST(PlaceFinder, SearchesNoFartherThanItsRegion) {
  const auto walls = RingWalls();
  const auto keyframes = LapIn(walls);
  const PlaceFinder finder(keyframes, {}, {});
  const Pose truth = FromXyYaw(5.1, 1.1, 0.05);
  const auto points = SeenIn(walls, truth);
  const PlaceFound near = finder.Find(keyframes, points, PlanRegion{FromXyYaw(6.4, 0.3, 0.25), 1.5, 0.3});
  ASSERT_TRUE(near.place);
  EXPECT_LT((near.place->T_map_base.translation() - truth.translation()).norm(), 0.03);
  EXPECT_FALSE(finder.Find(keyframes, points, PlanRegion{FromXyYaw(13.0, 6.0, 1.5), 1.5, 0.3}).place);
}

TEST(PlaceFinder, KnowsNoPlaceInABareCorridorWhereAllPlacesAreAlike) {
  const std::vector<PlanWall> walls{{-20, 1, 40, 1}, {-20, -1, 40, -1}};
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 60; ++i) keyframes.push_back(KeyframeIn(walls, FromXyYaw(0.25 * i, 0, 0), 0.25 * i));
  EXPECT_FALSE(PlaceFinder(keyframes, {}, {}).Find(keyframes, SeenIn(walls, FromXyYaw(7, 0, 0))).place);
}

TEST(PlaceFinder, KnowsNoPlaceWhereTwoRoomsOfTheMapAreAlike) {
  std::vector<PlanWall> twins = RingWalls();
  for (const PlanWall& wall : RingWalls()) twins.push_back({wall.x0 + 30, wall.y0, wall.x1 + 30, wall.y1});
  auto keyframes = LapIn(twins);
  for (Keyframe keyframe : LapIn(twins)) {
    keyframe.T_map_base.translation().x() += 30.0;
    keyframe.path_m += 100.0;
    keyframes.push_back(keyframe);
  }
  const PlaceFound search = PlaceFinder(keyframes, {}, {}).Find(keyframes, SeenIn(twins, FromXyYaw(5.1, 1.1, 0.05)));
  EXPECT_FALSE(search.place);
  EXPECT_EQ(search.fitting, 2);
}

TEST(PlaceFinder, KnowsNoPlaceInAForeignRoomNorOfNothingNorInAnEmptyMap) {
  const auto walls = RingWalls();
  const auto keyframes = LapIn(walls);
  const PlaceFinder finder(keyframes, {}, {});
  const std::vector<PlanWall> foreign{
      {0, 0, 5, 1.5}, {5, 1.5, 4, 5}, {4, 5, 0.5, 4.5}, {0.5, 4.5, 0, 0}, {2, 3, 3, 3.4}};
  EXPECT_FALSE(finder.Find(keyframes, ViewIn(foreign, FromXyYaw(1.0, 1.5, 0.4))).place);
  EXPECT_FALSE(finder.Find(keyframes, {}).place);
  EXPECT_FALSE(PlaceFinder({}, {}, {}).Find({}, SeenIn(walls, FromXyYaw(5, 1, 0))).place);
}

}  // namespace
}  // namespace merlin
