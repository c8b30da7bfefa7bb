#include "scenarios/run/car_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/room_box.h"
#include "tests/sim/world/car_world.h"

namespace merlin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// An arena of 6 x 4 m whose walls are 0.1 m thick.
constexpr char kArena[] = R"(<geom name="floor" type="plane" size="0 0 1"/>
  <geom type="box" pos="0 2.05 1" size="3.1 .05 1"/> <geom type="box" pos="0 -2.05 1" size="3.1 .05 1"/>
  <geom type="box" pos="3.05 0 1" size=".05 2 1"/> <geom type="box" pos="-3.05 0 1" size=".05 2 1"/>)";

// Puts the car into poses that physics would not reach.
void Hold(sim::World& world, const Pose& T_world_base) {
  const mjModel* model = world.model();
  int base = 0;
  while (!world.IsCarGeom(model->body_geomadr[base] < 0 ? 0 : model->body_geomadr[base])) ++base;
  base = model->body_rootid[base];
  mjtNum* q = const_cast<mjData*>(world.data())->qpos + model->jnt_qposadr[model->body_jntadr[base]];
  const Eigen::Quaterniond turn(T_world_base.linear());
  Eigen::Vector3d::Map(q) = T_world_base.translation();
  Eigen::Vector4d::Map(q + 3) = Eigen::Vector4d(turn.w(), turn.x(), turn.y(), turn.z());
}

// What the watch reports about a car that started at the origin of the arena and is now at this pose.
std::string LostAt(const Pose& T_world_base, const std::string& room = kArena) {
  const auto world = sim::MakeWorld(sim::Room(room));
  CarWatch watch(*world, false);
  Pose held = T_world_base;
  held.translation().z() += world->T_world_base().translation().z();
  Hold(*world, held);
  watch.Watch(*world);
  return watch.lost();
}

Pose At(double x_m, double y_m, double z_m = 0.0) { return Pose(Eigen::Translation3d(x_m, y_m, z_m)); }

TEST(CarWatch, ReportsNothingForACarThatDrives) {
  const auto world = sim::MakeWorld(sim::Room(kArena));
  CarWatch watch(*world, false);
  for (const double speed_m_s : {0.5, -0.5}) {
    sim::Send(*world, speed_m_s, 0.2);
    for (int i = 0; i < 1500; ++i) world->Step(), watch.Watch(*world);
  }
  EXPECT_EQ(watch.lost(), "");
}

TEST(CarWatch, LosesACarThatTiltsByMoreThan45Degrees) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(-0.6, 0.8, 0)})
    for (const double yaw_rad : {0.0, 2.5}) {
      const Pose turned = FromXyYaw(0, 0, yaw_rad);
      EXPECT_EQ(LostAt(turned * Eigen::AngleAxisd(44.9 * kDegree, axis)), "");
      EXPECT_NE(LostAt(turned * Eigen::AngleAxisd(45.1 * kDegree, axis)).find("tilted by 45.1 deg"), std::string::npos);
      EXPECT_NE(LostAt(turned * Eigen::AngleAxisd(std::numbers::pi, axis)).find("tilted by 180.0 deg"),
                std::string::npos);
    }
  EXPECT_EQ(LostAt(FromXyYaw(0, 0, std::numbers::pi)), "");
}

TEST(CarWatch, LosesACarThatSinksHalfAMetre) {
  EXPECT_EQ(LostAt(At(0, 0, -0.499)), "");
  EXPECT_EQ(LostAt(At(0, 0, 2.0)), "");
  EXPECT_NE(LostAt(At(0, 0, -0.501)).find("0.501 m below its start"), std::string::npos);
}

TEST(CarWatch, LosesACarThatLeavesTheRoomsBoxByAMetre) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(LostAt(At(sign * 4.09, 0)), "");
    EXPECT_EQ(LostAt(At(0, sign * 3.09)), "");
    EXPECT_NE(LostAt(At(sign * 4.11, 0)).find("left the room"), std::string::npos);
    EXPECT_NE(LostAt(At(0, sign * 3.11)).find("left the room"), std::string::npos);
  }
}

TEST(CarWatch, KnowsTheBoxOfEveryShape) {
  const auto box = [](const std::string& room) {
    return sim::RoomBox_m(*sim::MakeWorld(sim::Room(sim::kPlane + room)));
  };
  const auto expect = [&](const std::string& room, double x0, double y0, double x1, double y1) {
    const auto got = box(room);
    ASSERT_TRUE(got) << room;
    EXPECT_LT((got->min() - Eigen::Vector2d(x0, y0)).norm() + (got->max() - Eigen::Vector2d(x1, y1)).norm(), 1e-6)
        << room;
  };
  EXPECT_FALSE(box(""));                                                                  // infinite
  EXPECT_FALSE(box("<geom type='box' pos='7 0 1' size='.1 3 1'/>"));                      // the car is outside
  expect("<geom type='plane' pos='1 0 -1' size='4 2 1'/>", -3, -2, 5, 2);                 // a finite plane
  expect("<geom type='plane' pos='0 0 -1' size='4 2 1' euler='0 0 90'/>", -2, -4, 2, 4);  // rotated
  expect("<geom type='sphere' pos='0 0 9' size='2'/>", -2, -2, 2, 2);                     // above the car
  expect("<geom type='capsule' pos='0 0 9' size='1 2' euler='90 0 0'/>", -1, -3, 1, 3);   // along y
  expect("<body pos='1 1 9'><geom type='cylinder' size='3 .5'/></body>", -2, -2, 4, 4);   // on a body
}

TEST(CarWatch, LeavesObstaclesOutOfTheRoomsBox) {
  const auto world =
      sim::MakeWorld(sim::Room(kArena), Pose::Identity(), {{.appear_s = 1e3, .length_m = 20, .width_m = 20}});
  const auto box = sim::RoomBox_m(*world);
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->max().x(), 3.1, 1e-9);
}

TEST(CarWatch, LosesACarWhoseWheelsTouchNothingForHalfASecondExceptOnTheTurntable) {
  const sim::TemporaryFile file("room.xml", sim::Room(kArena));
  sim::World world({.room = file.path(), .car = sim::Merlin(), .turntable_rate_rad_s = 1.0});  // held in the air
  CarWatch free(world, false), on_turntable(world, true);
  while (world.Now() < std::chrono::milliseconds(500)) world.Step(), free.Watch(world), on_turntable.Watch(world);
  EXPECT_EQ(free.lost(), "");
  for (int i = 0; i < 1000; ++i) world.Step(), free.Watch(world), on_turntable.Watch(world);
  EXPECT_EQ(free.lost(), "at 0.502 s no wheel of the car had touched the ground for 0.5 s");
  EXPECT_EQ(on_turntable.lost(), "");
}

// A drop onto a plate that is not a floor: whatever carries the wheels is ground, a wall beside them is not.
TEST(CarWatch, TakesAnythingUnderTheWheelsForGround) {
  const auto world =
      sim::MakeWorld(sim::Room(std::string(kArena) + "<geom type='box' pos='1.7 0 .002' size='1 1 .004'/>"));
  CarWatch watch(*world, false);
  sim::Send(*world, 0.5, 0.0);
  sim::StepFor(*world, 3.0);
  sim::Send(*world, 0.0, 0.0);
  for (int i = 0; i < 1000; ++i) world->Step(), watch.Watch(*world);
  EXPECT_GT(world->T_world_base().translation().x(), 1.0);
  EXPECT_EQ(watch.lost(), "");
}

// The floor falls away twice as fast as the car, which has fallen 0.5 m after sqrt(2 x 0.5 m / g) = 0.319 s.
TEST(CarWatch, LosesACarThatFallsByTheLawOfFalling) {
  const auto world = sim::MakeWorld(sim::Room(R"(<body pos="0 0 -.5" gravcomp="-1"><joint type="slide" axis="0 0 1"/>
                                                 <geom name="floor" type="box" size="2 2 .5"/></body>)"));
  CarWatch watch(*world, false);
  while (watch.lost().empty() && world->Now() < std::chrono::seconds(2)) world->Step(), watch.Watch(*world);
  EXPECT_NE(watch.lost().find("m below its start"), std::string::npos) << watch.lost();
  EXPECT_NEAR(Seconds(world->Now()), std::sqrt(2.0 * 0.5 / 9.81), 0.01);
}

}  // namespace
}  // namespace merlin
