#include "scenarios/judge/map_truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenarios/judge/synthetic_room.h"

namespace merlin {
namespace {

// An empty room with these outer dimensions about the origin; its walls are infinitely high.
TrueRange RayInRoom(double width_m, double height_m) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    double range_m = HUGE_VAL;
    const auto meet = [&](int axis, double place_m) {
      const double t_m = (place_m - origin[axis]) / direction[axis];
      if (std::isfinite(t_m) && t_m > 0.0) range_m = std::min(range_m, t_m);
    };
    for (const double side : {-0.5, 0.5}) {
      meet(0, side * width_m);
      meet(1, side * height_m);
    }
    meet(2, 0.0);
    return range_m;
  };
}

Trajectory Standing(double x_m, double y_m) { return {{Time(0), FromXyYaw(x_m, y_m, 0)}}; }

TEST(Coverage, IsWholeForAWholeMapAndZeroForNone) {
  const Outline room = Rectangle(6, 4);
  const auto coverage = [&room](const std::vector<MapPoint>& map) {
    return CoveragePercent(map, Pose::Identity(), room, Standing(0, 0), RayInRoom(6, 4)).value();
  };
  EXPECT_EQ(coverage(CloudOfWalls(room)), 100.0);
  EXPECT_EQ(coverage({}), 0.0);
}

TEST(Coverage, IsTheShareOfWallLengthWithPoints) {
  const Outline room = Rectangle(6, 4);  // 20 m around, 400 samples
  std::vector<MapPoint> map;
  AddWall(map, {-3, -2}, {3, -2});  // 120 samples, and two of each neighbouring wall within 0.10 m of its end points
  EXPECT_NEAR(CoveragePercent(map, Pose::Identity(), room, Standing(0, 0), RayInRoom(6, 4)).value(), 100.0 * 124 / 400,
              1e-9);
}

TEST(Coverage, CountsOnlyPointsNearEnoughAndOfTheRightHeight) {
  const Outline room = Rectangle(6, 4);
  const auto coverage = [&room](double shift_m, double height_min_m, double height_max_m) {
    std::vector<MapPoint> map;
    AddWall(map, {-3, -2 + shift_m}, {3, -2 + shift_m}, height_max_m);
    std::erase_if(map, [=](const MapPoint& point) { return point.p_map.z() < height_min_m; });
    return CoveragePercent(map, Pose::Identity(), room, Standing(0, 0), RayInRoom(6, 4)).value();
  };
  EXPECT_GE(coverage(0.09, 0.0, 2.2), 30.0);
  EXPECT_LE(coverage(0.11, 0.0, 2.2), 2.5);  // a few samples of the side walls
  EXPECT_EQ(coverage(0.0, 0.0, 0.09), 0.0);
  EXPECT_EQ(coverage(0.0, 2.05, 2.5), 0.0);
  EXPECT_GE(coverage(0.0, 1.9, 2.1), 30.0);
}

TEST(Coverage, AsksOnlyForWallsWithinSight) {
  // In a corridor 40 m long and 2 m wide, seen from its middle, a view of 7 m reaches sqrt(7^2 - 1^2 - 0.65^2) = 6.897
  // m along the walls in both directions. The map covers one side from 0 to 6.897 m, a quarter of that, and walls out
  // of view.
  std::vector<MapPoint> map;
  AddWall(map, {0.1, 1}, {20, 1});
  const std::optional<double> coverage =
      CoveragePercent(map, Pose::Identity(), Rectangle(40, 2), Standing(0, 0), RayInRoom(40, 2));
  ASSERT_TRUE(coverage);
  EXPECT_NEAR(*coverage, 25.0, 0.2);  // 138 samples a quarter
}

TEST(Coverage, DoesNotAskForWhatIsHidden) {
  // A screen across the room at x = 1 hides what lies behind it.
  const TrueRange screened = [room = RayInRoom(6, 4)](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const double t_m = (1.0 - origin.x()) / direction.x();
    return std::min(room(origin, direction), t_m > 0.0 ? t_m : HUGE_VAL);
  };
  std::vector<MapPoint> map = CloudOfWalls(Rectangle(6, 4));
  std::erase_if(map, [](const MapPoint& point) { return point.p_map.x() > 1.0f; });
  EXPECT_EQ(CoveragePercent(map, Pose::Identity(), Rectangle(6, 4), Standing(0, 0), screened), 100.0);
  const Trajectory both_sides{{Time(0), FromXyYaw(0, 0, 0)}, {Time(1), FromXyYaw(2, 0, 0)}};
  EXPECT_NEAR(CoveragePercent(map, Pose::Identity(), Rectangle(6, 4), both_sides, screened).value(), 60.0, 2.0);
}

TEST(Coverage, IsNotKnownWhereNothingIsVisible) {
  const std::vector<MapPoint> map = CloudOfWalls(Rectangle(6, 4));
  const TrueRange blind = [](const Eigen::Vector3d&, const Eigen::Vector3d&) { return 0.1; };
  const TrueRange void_room = [](const Eigen::Vector3d&, const Eigen::Vector3d&) { return HUGE_VAL; };
  for (const TrueRange& range : {blind, void_room})
    EXPECT_FALSE(CoveragePercent(map, Pose::Identity(), Rectangle(6, 4), Standing(0, 0), range));
  EXPECT_FALSE(CoveragePercent(map, Pose::Identity(), Rectangle(6, 4), {}, RayInRoom(6, 4)));
  EXPECT_FALSE(CoveragePercent(map, Pose::Identity(), {}, Standing(0, 0), RayInRoom(6, 4)));
}

TEST(MapToPlan, IsTheWallsDistance) {
  // Walls 3 cm inside the true ones, in a map frame that is rotated and shifted.
  const Pose T_world_map = FromXyYaw(5, 6, 0.7);
  std::vector<MapPoint> map = CloudOfWalls(Rectangle(5.94, 3.94));
  for (MapPoint& point : map) point.p_map = (T_world_map.inverse() * point.p_map.cast<double>()).cast<float>();
  EXPECT_NEAR(MapToPlanP95_m(map, T_world_map, RayInRoom(6, 4)).value(), 0.03, 2e-6);
  // The same distance outside, within the wall.
  EXPECT_NEAR(MapToPlanP95_m(CloudOfWalls(Rectangle(6.06, 4.06)), Pose::Identity(), RayInRoom(6, 4)).value(), 0.03,
              2e-6);
}

TEST(MapToPlan, ShowsADoubledWall) {
  std::vector<MapPoint> map = CloudOfWalls(Rectangle(5.98, 3.98));
  AddWall(map, {-1, -1.7}, {1, -1.7});  // a second wall 0.30 m inside, with more than a twentieth of the points
  EXPECT_NEAR(MapToPlanP95_m(map, Pose::Identity(), RayInRoom(6, 4)).value(), 0.30, 2e-6);
}

TEST(MapToPlan, LooksAlongTheNormalOfASlantingWall) {
  // A true wall through the origin at 45 degrees; the map's lies 0.1 m before it.
  const Eigen::Vector3d normal = Eigen::Vector3d(1, -1, 0).normalized();
  const TrueRange slanting = [&normal](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const double t_m = -normal.dot(origin) / normal.dot(direction);
    return std::isfinite(t_m) && t_m > 0.0 ? t_m : HUGE_VAL;
  };
  std::vector<MapPoint> map;
  const Eigen::Vector2d shift = 0.1 * normal.head<2>();
  AddWall(map, Eigen::Vector2d(-1, -1) + shift, Eigen::Vector2d(1, 1) + shift);
  EXPECT_NEAR(MapToPlanP95_m(map, Pose::Identity(), slanting).value(), 0.1, 1e-5);
}

TEST(MapToPlan, LeavesTheFloorOut) {
  std::vector<MapPoint> map = CloudOfWalls(Rectangle(5.98, 3.98));
  for (int i = 0; i < 10000; ++i)  // a level board in the middle of the room, a metre from anything
    map.push_back({{-0.5f + 0.01f * static_cast<float>(i % 100), -0.5f + 0.01f * static_cast<float>(i / 100), 1.0f}});
  EXPECT_NEAR(MapToPlanP95_m(map, Pose::Identity(), RayInRoom(6, 4)).value(), 0.01, 2e-6);
}

TEST(MapToPlan, IsNotKnownWithoutWallPointsOrSurfaces) {
  EXPECT_FALSE(MapToPlanP95_m({}, Pose::Identity(), RayInRoom(6, 4)));
  const TrueRange void_room = [](const Eigen::Vector3d&, const Eigen::Vector3d&) { return HUGE_VAL; };
  EXPECT_FALSE(MapToPlanP95_m(CloudOfWalls(Rectangle(6, 4)), Pose::Identity(), void_room));
}

}  // namespace
}  // namespace merlin
