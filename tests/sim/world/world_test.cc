#include "sim/world/world.h"

#include <gtest/gtest.h>

#include <limits>

#include "robot/base/error.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

// The message of the InputError that a call throws; empty if it throws none.
template <class Call>
std::string ErrorOf(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void ExpectSays(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' not in: " << text;
}

std::string Wall(double x_m, double thickness_m) {
  return fmt::format(R"(<geom name="wall" type="box" pos="{} 0 0.5" size="{} 2 0.5"/>)", x_m, thickness_m / 2);
}

TEST(World, CarHasItsMassAndStandsOnTheFloor) {
  const auto world = EmptyWorld();
  const int base = mj_name2id(world->model(), mjOBJ_BODY, "base_link");
  EXPECT_NEAR(world->model()->body_subtreemass[base], 6.5, 1e-9);
  EXPECT_NEAR(world->data()->subtree_com[3 * base + 2], 0.110, 0.0005);
  StepFor(*world, 0.5);
  // Each tyre carries a quarter of the weight: nothing else supports the car.
  EXPECT_EQ(world->data()->ncon, 4);
  EXPECT_TRUE(world->CarTouches().empty());
  EXPECT_NEAR(world->T_world_base().translation().z(), 0.0, 0.0005);
  EXPECT_NEAR(world->T_world_base().linear()(2, 0), 0.0, 0.001);
}

TEST(World, StepsInTwoMilliseconds) {
  const auto world = MakeWorld(Room(kPlane, R"(<option timestep="0.01" integrator="RK4"/>)"));
  EXPECT_EQ(world->Now(), Time(0));
  for (int i = 0; i < 1000; ++i) world->Step();
  EXPECT_EQ(world->Now(), FromSeconds(2.0));
}

TEST(World, StartsWhereTheFloorIs) {
  const std::string slab = R"(<geom name="floor_slab" type="box" pos="0 0 0.05" size="3 3 0.05"/>)";
  const auto world = MakeWorld(Room(slab), FromXyYaw(1.0, -0.5, 2.0));
  EXPECT_NEAR(world->T_world_base().translation().x(), 1.0, 1e-12);
  EXPECT_NEAR(world->T_world_base().translation().y(), -0.5, 1e-12);
  EXPECT_NEAR(world->T_world_base().translation().z(), 0.1, 1e-12);
  EXPECT_NEAR(Yaw(world->T_world_base()), 2.0, 1e-12);
  StepFor(*world, 0.5);
  EXPECT_NEAR(world->T_world_base().translation().z(), 0.1, 0.0005);
}

TEST(World, SpeedIsSignedAndAlongTheCar) {
  const auto world = MakeWorld(Room(kPlane), FromXyYaw(0.0, 0.0, 2.5), {}, IdealDrivetrain());
  EXPECT_EQ(world->Speed_m_s(), 0.0);
  Send(*world, -0.4, 0.0);
  StepFor(*world, 1.0);
  const Eigen::Vector3d before = world->T_world_base().translation();
  StepFor(*world, 0.5);
  EXPECT_NEAR(world->Speed_m_s(), -(world->T_world_base().translation() - before).norm() / 0.5, 1e-4);
}

TEST(World, SameCommandsGiveTheSameBitsWhateverIsReadInBetween) {
  const auto run = [](bool read) {
    const auto world = MakeWorld(Room(std::string(kPlane) + Wall(2.0, 0.1)), Pose::Identity(), {{.ahead_m = 5.0}});
    Send(*world, 1.0, 0.1);
    for (int i = 0; i < 1500; ++i) {
      world->Step();
      if (read) world->CarTouches(), world->ActorDistance_m(0, 10.0), Read(*world), world->T_world_base();
    }
    return world->State();
  };
  const std::vector<double> state = run(false);
  EXPECT_EQ(state, run(false));
  EXPECT_EQ(state, run(true));
  EXPECT_NEAR(state[0], 3.0, 1e-9);           // time
  EXPECT_EQ(state.size(), 1u + 14 + 13 + 1);  // free joint and seven hinges; the servo's slew
}

TEST(World, ReportsTheWallItDrivesInto) {
  const auto world = MakeWorld(Room(std::string(kPlane) + Wall(1.5, 0.1)));
  Send(*world, 0.5, 0.0);
  Time first{0};
  std::vector<Touch> touches;  // with spinning wheels not every step has contact
  while (world->Now() < FromSeconds(4.0)) {
    world->Step();
    if (!world->CarTouches().empty()) touches = world->CarTouches();
    if (first == Time(0) && !touches.empty()) first = world->Now();
  }
  // The bumper at 0.45 m reaches 1.45 m after 1 m: v / 2a + s / v.
  EXPECT_NEAR(Seconds(first), 0.125 + 1.0 / 0.5, 0.05);
  ASSERT_FALSE(touches.empty());
  EXPECT_EQ(touches[0].car_geom, "chassis_collision_2");
  EXPECT_EQ(touches[0].other_geom, "wall");
  EXPECT_LT(world->T_world_base().translation().x(), 1.01);
  Send(*world, -0.5, 0.0);
  StepFor(*world, 1.5);
  EXPECT_TRUE(world->CarTouches().empty());
}

TEST(World, AWheelOnWhatIsNotFloorIsATouch) {
  const std::string step = R"(<geom name="step" type="box" pos="2 0 0" size="1 2 0.004"/>)";
  const auto world = MakeWorld(Room(std::string(kPlane) + step));
  EXPECT_TRUE(world->CarTouches().empty());
  Send(*world, 0.5, 0.0);
  StepFor(*world, 2.0);  // the front wheels are on it
  ASSERT_FALSE(world->CarTouches().empty());
  EXPECT_TRUE(world->CarTouches()[0].car_geom.starts_with("wheel_front_"));
  EXPECT_EQ(world->CarTouches()[0].other_geom, "step");
  EXPECT_GT(world->T_world_base().translation().x(), 0.8);
}

TEST(World, KnowsTheCarsGeoms) {
  const auto world = EmptyWorld();
  const auto id = [&](const char* name) { return mj_name2id(world->model(), mjOBJ_GEOM, name); };
  EXPECT_FALSE(world->IsCarGeom(id("floor")));
  EXPECT_TRUE(world->IsCarGeom(id("wheel_rear_left_visual_0")));
  EXPECT_TRUE(world->IsCarGeom(id("wheel_front_left_collision_0")));
  EXPECT_TRUE(world->IsCarGeom(id("depth_camera_visual_0")));
}

TEST(World, DrawsVisualShapesAndHidesCollisionShapes) {
  const auto world = EmptyWorld();
  for (int geom = 0; geom < world->model()->ngeom; ++geom)
    EXPECT_TRUE(!world->IsCarGeom(geom) ||
                (world->model()->geom_group[geom] <= 2) == (world->model()->geom_contype[geom] == 0));
}

TEST(World, OpticalFramesStandWhereTheDescriptionSays) {
  const CarDescription car = Merlin();
  const Pose T_world_start = FromXyYaw(1.0, 2.0, 0.7);
  const auto world = MakeWorld(Room(kPlane), T_world_start);
  const int body = mj_name2id(world->model(), mjOBJ_BODY, "color_camera_optical_frame");
  const Pose expected = T_world_start * *car.T_base_color;
  EXPECT_LT((Eigen::Vector3d::Map(world->data()->xpos + 3 * body) - expected.translation()).norm(), 1e-9);
  const Eigen::Matrix3d rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(world->data()->xmat + 9 * body);
  EXPECT_LT((rotation - expected.linear()).norm(), 1e-9);
}

TEST(World, ObstacleComesAndGoes) {
  const auto world =
      MakeWorld(Room(kPlane), Pose::Identity(),
                {{.appear_s = 0.1, .disappear_s = 0.3, .ahead_m = 2.8, .width_m = 0.6}, {.appear_s = 1e3}});
  EXPECT_FALSE(world->actors().present(0));
  EXPECT_EQ(world->ActorDistance_m(0, 10.0), 10.0);
  EXPECT_NEAR(world->ActorDistance_m(0, 1e3), world->ActorDistance_m(1, 1e3), 1e-9);
  StepFor(*world, 0.1);
  EXPECT_TRUE(world->actors().present(0));
  EXPECT_NEAR(world->ActorDistance_m(0, 10.0), 2.8 - 0.45, 1e-3);  // before the car's front
  EXPECT_EQ(world->ActorDistance_m(0, 1.0), 1.0);
  const int geom = mj_name2id(world->model(), mjOBJ_GEOM, "obstacle_0");
  EXPECT_NEAR(world->data()->geom_xpos[3 * geom], 3.0, 1e-3);        // half a box farther
  EXPECT_NEAR(world->data()->geom_xpos[3 * geom + 2], 0.25, 1e-12);  // stands on the floor
  StepFor(*world, 0.1);
  EXPECT_TRUE(world->CarTouches().empty());
  StepFor(*world, 0.1);
  EXPECT_EQ(world->ActorDistance_m(0, 10.0), 10.0);
  Send(*world, 1.0, 0.0);
  StepFor(*world, 4.0);
  EXPECT_GT(world->T_world_base().translation().x(), 3.5);
  EXPECT_TRUE(world->CarTouches().empty());
}

TEST(World, ObstacleStandsAheadOfTheCarWhereverThatIs) {
  const auto world = MakeWorld(Room(kPlane), FromXyYaw(1.0, 2.0, std::numbers::pi / 2),
                               {{.ahead_m = 2.0, .left_m = 0.5, .length_m = 0.4}});
  const int geom = mj_name2id(world->model(), mjOBJ_GEOM, "obstacle_0");
  EXPECT_NEAR(world->data()->geom_xpos[3 * geom], 0.5, 1e-9);
  EXPECT_NEAR(world->data()->geom_xpos[3 * geom + 1], 2.0 + 2.2, 1e-9);
}

TEST(World, ObstacleStopsTheCar) {
  const auto world = MakeWorld(Room(kPlane), Pose::Identity(), {{.ahead_m = 1.3}});
  Send(*world, 0.5, 0.0);
  while (world->Now() < FromSeconds(4.0) && world->CarTouches().empty()) world->Step();
  ASSERT_FALSE(world->CarTouches().empty());
  EXPECT_EQ(world->CarTouches()[0].other_geom, "obstacle_0");
  EXPECT_NEAR(world->ActorDistance_m(0, 10.0), 0.0, 0.002);
  StepFor(*world, 2.0);
  EXPECT_NEAR(world->ActorDistance_m(0, 10.0), 0.0, 0.005);
}

TEST(World, RefusesAnObstacleThatStartsInTheCar) {
  ExpectSays(ErrorOf([] { MakeWorld(Room(kPlane), Pose::Identity(), {{.ahead_m = 0.0}}); }),
             {"obstacle 0", "touches the car"});
}

TEST(World, ReadsPlanAndNorth) {
  const std::string custom =
      R"(<custom><numeric name="plan_xy_m" data="0 0 4 0 4 3"/><numeric name="north_yaw_rad" data="1.5"/></custom>)";
  const auto world = MakeWorld(Room(kPlane, custom));
  ASSERT_EQ(world->plan_xy_m().size(), 3u);
  EXPECT_EQ(world->plan_xy_m()[2], Eigen::Vector2d(4, 3));
  EXPECT_EQ(world->north_yaw_rad(), 1.5);
  EXPECT_TRUE(EmptyWorld()->plan_xy_m().empty());
  EXPECT_EQ(EmptyWorld()->north_yaw_rad(), 0.0);
  for (const std::string data : {"0 0 1 0 1", "0 0 1 0"})
    ExpectSays(ErrorOf([&] {
                 MakeWorld(Room(kPlane, R"(<custom><numeric name="plan_xy_m" data=")" + data + R"("/></custom>)"));
               }),
               {"room.xml", "plan_xy_m"});
}

TEST(World, RoomsOwnDefaultsDoNotAffectTheCar) {
  const auto world = MakeWorld(Room(kPlane, R"(<compiler angle="radian" inertiafromgeom="true" settotalmass="100"/>
    <default><geom contype="0" margin="1" friction="0.01"/><joint damping="9" armature="9"/><general gear="5"/></default>)"
                                            "<statistic extent=\"3\"/>"));
  const mjModel* m = world->model();
  const int base = mj_name2id(m, mjOBJ_BODY, "base_link"),
            steering = mj_name2id(m, mjOBJ_JOINT, "virtual_front_wheel_joint");
  EXPECT_NEAR(m->body_subtreemass[base], 6.5, 1e-9);
  EXPECT_NEAR(m->jnt_range[2 * steering + 1], Merlin().steering_max_rad, 1e-12);
  EXPECT_NEAR(EmptyWorld()->model()->jnt_range[2 * steering + 1], Merlin().steering_max_rad, 1e-12);  // degrees there
  EXPECT_EQ(m->dof_damping[m->jnt_dofadr[steering]], 0.0);
  EXPECT_EQ(m->geom_margin[mj_name2id(m, mjOBJ_GEOM, "wheel_front_left_collision_0")], 0.0);
}

TEST(World, RefusesAStartInAWall) {
  const auto refuse = [](const std::string& wall, double x_m = 0.0) {
    const std::string text = ErrorOf([&] { MakeWorld(Room(std::string(kPlane) + wall), FromXyYaw(x_m, 0.0, 0.0)); });
    ExpectSays(text, {"room.xml", "cannot start at x", "'wall'"});
  };
  refuse(Wall(0.47, 0.1));                                                                  // the bumper in it
  refuse(Wall(0.2, 0.1));                                                                   // across the car
  refuse(Wall(0.0, 10.0));                                                                  // wholly inside
  refuse(R"(<geom name="wall" type="box" pos="7 0 5" size="9 9 9"/>)", 5.0);                // deep inside a block
  refuse(R"(<geom name="wall" type="cylinder" pos="0 0 1" size="4 3"/>)");                  // inside a column
  refuse(R"(<geom name="wall" type="sphere" pos="0 0 0" size="5"/>)");                      // inside a ball
  refuse(R"(<geom name="wall" type="plane" pos="0.3 0 0" zaxis="-1 0 0" size="5 5 1"/>)");  // beyond a plane
  EXPECT_EQ(ErrorOf([] { MakeWorld(Room(std::string(kPlane) + Wall(0.51, 0.1))); }), "");   // 1 cm free
}

TEST(World, RefusesAStartOffTheFloor) {
  const std::string slab = R"(<geom name="floor" type="box" pos="0 0 -0.05" size="3 3 0.05"/>)";
  ExpectSays(ErrorOf([&] { MakeWorld(Room(slab), FromXyYaw(5.0, 0.0, 0.0)); }), {"room.xml", "floor", "x 5 m"});
  ExpectSays(ErrorOf([] { MakeWorld(Room(R"(<geom name="ground" type="plane" size="0 0 1"/>)")); }),
             {"no floor", "floor*"});
  ExpectSays(ErrorOf([] { MakeWorld(Room("")); }), {"no floor"});
}

TEST(World, RefusesABadRoomWithFileAndLine) {
  ExpectSays(ErrorOf([] { World({.room = "/nowhere/room.xml", .car = Merlin()}); }),
             {"/nowhere/room.xml", "no such room"});
  ExpectSays(ErrorOf([] { World({.room = std::filesystem::temp_directory_path(), .car = Merlin()}); }),
             {"no such room"});
  ExpectSays(ErrorOf([] { MakeWorld("<mujoco>\n<worldbody>\n</mujoco>"); }), {"room.xml:", "not a room"});
  ExpectSays(ErrorOf([] { MakeWorld(""); }), {"room.xml"});
  ExpectSays(ErrorOf([] { MakeWorld("<mujoco>\n\n\n<worldbdy/>\n</mujoco>"); }), {"room.xml:4", "worldbdy"});
  ExpectSays(
      ErrorOf([] { MakeWorld("<mujoco><worldbody>\n<geom type=\"box\" size=\"1 x 1\"/>\n</worldbody></mujoco>"); }),
      {"room.xml:2"});
  ExpectSays(ErrorOf([] { MakeWorld(Room("\n<geom type=\"box\" size=\"1 -1 1\"/>")); }), {"room.xml:5"});
  ExpectSays(ErrorOf([] {
               MakeWorld(Room(R"(<geom type="mesh" mesh="m"/>)", R"(<asset><mesh name="m" file="none.obj"/></asset>)"));
             }),
             {"room.xml", "none.obj"});
  ExpectSays(ErrorOf([] { MakeWorld(Room(R"(<geom name="chassis_collision_0" size="1"/>)")); }),
             {"used twice", "chassis_collision_0"});
}

std::unique_ptr<World> WithCurtain(const std::filesystem::path& room, bool closed) {
  return std::make_unique<World>(WorldOptions{.room = room, .car = Merlin(), .curtain_closed = closed});
}

constexpr char kRoom7x10[] = MERLIN_SOURCE_DIR "/models/rooms/room_7x10.xml";

// The first geom that a ray hits, and its distance.
struct Met {
  std::string geom;
  double range_m = -1.0;
};

Met Look(const World& world, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  constexpr mjtByte kSeenGroups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
  const Eigen::Vector3d unit = direction.normalized();
  int geom = -1;
  const double range_m =
      mj_ray(world.model(), world.data(), from.data(), unit.data(), kSeenGroups, 1, -1, &geom, nullptr);
  const char* name = geom < 0 ? nullptr : mj_id2name(world.model(), mjOBJ_GEOM, geom);
  return {name == nullptr ? "" : name, range_m};
}

TEST(World, TakesAnOpenCurtainOutAndHangsAClosedOne) {
  const TemporaryFile file("room.xml", Room(std::string(kPlane) + R"(
    <geom name="curtain" type="box" pos="2 0 1" size=".01 1 1"/>
    <body pos="3 0 1"><geom name="curtain_2" type="box" size=".01 1 1"/><geom name="old_curtain" size=".1"/></body>)"));
  const auto open = WithCurtain(file.path(), false), closed = WithCurtain(file.path(), true);
  const auto has = [](const World& world, const char* name) {
    return mj_name2id(world.model(), mjOBJ_GEOM, name) >= 0;
  };
  for (const char* name : {"curtain", "curtain_2"}) {
    EXPECT_FALSE(has(*open, name)) << name;
    EXPECT_TRUE(has(*closed, name)) << name;
  }
  EXPECT_TRUE(has(*open, "old_curtain"));
  EXPECT_EQ(closed->model()->ngeom, open->model()->ngeom + 2);
}

TEST(World, RefusesToCloseACurtainThatIsNotThere) {
  const TemporaryFile file("room.xml", Room(kPlane));
  EXPECT_EQ(ErrorOf([&] { WithCurtain(file.path(), false); }), "");
  ExpectSays(ErrorOf([&] { WithCurtain(file.path(), true); }), {"room.xml", "no curtain to close", "curtain*"});
}

TEST(World, OmitsTheGeomsThatTheRoomLeavesOutOfAnIncludedOne) {
  constexpr char kWalls[] = R"(<geom name="floor" type="plane" size="0 0 1"/>
    <geom name="wall_a" type="box" pos="5 0 1" size=".1 1 1"/> <geom name="wall_b" type="box" pos="8 0 1" size=".1 1 1"/>)";
  const TemporaryFile whole("whole.xml", Room(kWalls));
  const auto with = [&](const std::string& left_out) {
    return fmt::format(R"(<mujoco><include file="{}"/><custom><text name="leave_out" data="{}"/></custom></mujoco>)",
                       whole.path().string(), left_out);
  };
  const TemporaryFile part("part.xml", with("wall_a"));
  const auto world = WithCurtain(part.path(), false);
  EXPECT_LT(mj_name2id(world->model(), mjOBJ_GEOM, "wall_a"), 0);
  EXPECT_GE(mj_name2id(world->model(), mjOBJ_GEOM, "wall_b"), 0);
  const TemporaryFile wrong("wrong.xml", with("wall_b wall_c"));
  ExpectSays(ErrorOf([&] { WithCurtain(wrong.path(), false); }), {"wrong.xml", "leave_out", "'wall_c'"});
}

TEST(Room7x10, StandsOnItsPlan) {
  const auto world = WithCurtain(kRoom7x10, false);
  const std::vector<Eigen::Vector2d>& plan = world->plan_xy_m();
  ASSERT_EQ(plan.size(), 4u);
  const double expected_m[] = {3.5, 5.0, 3.5, 5.0};  // half of 7.00 and 10.00 m
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d edge = (plan[(i + 1) % 4] - plan[i]).normalized();
    const Eigen::Vector3d outward(edge.y(), -edge.x(), 0.0);  // the outline runs counter-clockwise
    EXPECT_NEAR(outward.head<2>().dot(plan[i]), expected_m[i], 1e-4);
    // Above the furniture and the windows.
    EXPECT_NEAR(Look(*world, {0.0, 0.0, 2.6}, outward).range_m, expected_m[i], 1e-4) << i;
  }
}

TEST(Room7x10, CurtainHidesEveryPane) {
  const auto open = WithCurtain(kRoom7x10, false), closed = WithCurtain(kRoom7x10, true);
  const Eigen::Vector3d eye(0.0, 0.0, 1.6);
  int panes = 0;
  for (int geom = 0; geom < open->model()->ngeom; ++geom) {
    const char* name = mj_id2name(open->model(), mjOBJ_GEOM, geom);
    if (name == nullptr || !std::string_view(name).starts_with("window")) continue;
    const Eigen::Vector3d towards = Eigen::Vector3d::Map(open->data()->geom_xpos + 3 * geom) - eye;
    EXPECT_EQ(Look(*open, eye, towards).geom, name);
    EXPECT_TRUE(Look(*closed, eye, towards).geom.starts_with("curtain")) << name;
    ++panes;
  }
  EXPECT_EQ(panes, 8);
}

TEST(World, StopsLoudlyWhenTheStateIsBad) {
  const auto world = EmptyWorld();
  world->data()->qvel[0] = std::numeric_limits<double>::quiet_NaN();  // data is const, what it points to is not
  EXPECT_THROW(StepFor(*world, 0.01), std::runtime_error);
}

TEST(World, TurnsMujocosOwnErrorsIntoExceptions) {
  const auto world = EmptyWorld();
  EXPECT_THROW(mju_error("test"), std::runtime_error);
}

}  // namespace
}  // namespace merlin::sim
