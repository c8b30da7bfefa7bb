#include "autonomy/free_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "robot/kinematics/motion.h"
#include "tests/autonomy/car.h"
#include "tests/autonomy/toy_car.h"

namespace merlin {
namespace {

constexpr double kCell_m = 0.05;  // of an OccupancyConfig
const BackConfig kBack;

// Straight back from the origin.
std::vector<Eigen::Vector2d> StraightBack(double length_m) { return ArcAhead(Car(), 0.0, -length_m); }

std::optional<double> Free_m(const OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& path_base,
                             const Pose& T_map_base = Pose::Identity()) {
  return FreeGround_m(grid, FootprintOf(Car()), T_map_base, path_base, kBack);
}

// Makes the ground known from the first x on, wider than the car needs.
OccupancyGrid KnownFrom(double x_m) {
  OccupancyGrid grid({});
  SeeFree(grid, x_m, 1.0, -1.0, 1.0);
  return grid;
}

TEST(FreeGround, RefusesUnknownGround) {
  EXPECT_EQ(Free_m(OccupancyGrid({}), StraightBack(2.0)), 0.0);
  EXPECT_FALSE(Free_m(OccupancyGrid({}), {})) << "no path, no obstacle on it";
}

TEST(FreeGround, IsAllOfThePathWhereTheMapKnowsIt) {
  EXPECT_FALSE(Free_m(KnownFrom(-3.0), StraightBack(2.0)));
  EXPECT_FALSE(Free_m(KnownFrom(-3.0), {Eigen::Vector2d::Zero()}));
}

TEST(FreeGround, EndsAGapBeforeUnknownGround) {
  // The rear is 0.45 m behind the origin.
  for (const double from_m : {-1.0, -1.5, -2.2}) {
    const auto free_m = Free_m(KnownFrom(from_m), StraightBack(3.0));
    ASSERT_TRUE(free_m);
    EXPECT_LE(*free_m, -from_m - 0.45 - kBack.stop_gap_m + 1e-6);
    EXPECT_GE(*free_m, -from_m - 0.45 - kBack.stop_gap_m - kCell_m);
  }
}

TEST(FreeGround, EndsAGapBeforeAnOccupiedCellAnywhereBehindTheCar) {
  const double side_m = 0.15 + kBack.margin_m;
  for (double y = -0.245; y < 0.25; y += 0.01) {
    OccupancyGrid grid = KnownFrom(-3.0);
    SeeOccupied(grid, -1.51, y);  // in the cell from -1.55 to -1.50
    const auto free_m = Free_m(grid, StraightBack(2.0));
    const double cell_low = std::floor(y / kCell_m) * kCell_m, cell_high = cell_low + kCell_m;
    const bool in_the_way = cell_low < side_m - 1e-6 && cell_high > -side_m + 1e-6;
    ASSERT_EQ(free_m.has_value(), in_the_way) << y;
    if (!free_m) continue;
    EXPECT_LE(*free_m, 1.5 - 0.45 - kBack.stop_gap_m + 1e-6) << y;
    EXPECT_GE(*free_m, 1.5 - 0.45 - kBack.stop_gap_m - kCell_m) << y;
  }
}

TEST(FreeGround, IsTheSameInAnyPose) {
  for (const double yaw_rad : {0.0, 0.7, -2.0, std::numbers::pi}) {
    const Pose T_map_base = FromXyYaw(0.3, -0.4, yaw_rad);
    OccupancyGrid grid({});
    SeeFree(grid, -4.0, 4.0, -4.0, 4.0);
    EXPECT_FALSE(Free_m(grid, StraightBack(2.0), T_map_base));
    const Eigen::Vector3d wall = T_map_base * Eigen::Vector3d(-1.5, 0.0, 0.0);
    SeeOccupied(grid, wall.x(), wall.y());
    const auto free_m = Free_m(grid, StraightBack(2.0), T_map_base);
    ASSERT_TRUE(free_m) << yaw_rad;
    EXPECT_NEAR(*free_m, 1.5 - 0.45 - kBack.stop_gap_m, 1.5 * kCell_m) << yaw_rad;
  }
}

TEST(FreeGround, WatchesTheFrontThatSwingsOutOnAnArc) {
  OccupancyGrid grid({});
  SeeFree(grid, -3.0, 2.0, -3.0, 3.0);
  const auto arc = ArcAhead(Car(), 0.4, -0.8);  // backs to the left: the front swings to the right
  EXPECT_FALSE(Free_m(grid, arc));
  SeeOccupied(grid, 0.12, -0.22);
  const auto free_m = Free_m(grid, arc);
  ASSERT_TRUE(free_m);
  EXPECT_LT(*free_m, 0.5);
  // The same cell is beside a car that backs straight.
  EXPECT_FALSE(Free_m(grid, StraightBack(0.8)));
}

TEST(FreeGround, TakesTheGroundBelowTheCarForFree) {
  OccupancyGrid grid = KnownFrom(-3.0);
  SeeOccupied(grid, -0.2, 0.0);  // an error of the map: the car itself is there
  EXPECT_FALSE(Free_m(grid, StraightBack(0.02)));
}

TEST(FreeGround, NeedsNotHaveSeenWhatIsBesideTheStandingCar) {
  OccupancyGrid grid({});
  SeeFree(grid, -3.0, -0.40, -1.0, 1.0);  // all beside it but the last bit is unknown
  EXPECT_FALSE(Free_m(grid, StraightBack(2.0)));
  EXPECT_TRUE(Free_m(grid, ArcAhead(Car(), 0.4, -0.8))) << "the front would swing over unknown ground";
  SeeOccupied(grid, 0.2, 0.17);
  EXPECT_EQ(Free_m(grid, StraightBack(2.0)), 0.0) << "it is too near to back";
}

}  // namespace
}  // namespace merlin
