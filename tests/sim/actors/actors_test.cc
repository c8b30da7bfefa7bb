#include "sim/actors/actors.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "robot/base/error.h"
#include "sim/actors/actor_body.h"
#include "sim/world/room_box.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

constexpr double kFront_m = 0.45;  // of the car's front, ahead of base_link

const std::string kHall = std::string(kPlane) + R"(<geom type="box" pos="6 0 1" size=".1 6 1"/>
  <geom type="box" pos="-6 0 1" size=".1 6 1"/><geom type="box" pos="0 6 1" size="6 .1 1"/>
  <geom type="box" pos="0 -6 1" size="6 .1 1"/>)";

std::unique_ptr<World> WorldWith(const std::vector<ActorConfig>& actors, const std::string& room = kPlane) {
  const TemporaryFile file("room.xml", Room(room));
  return std::make_unique<World>(WorldOptions{.room = file.path(), .car = Merlin(), .actors = actors});
}

ActorConfig Box(const std::vector<std::vector<double>>& path) {
  return {.name = "cart", .shape = "box", .size_m = {0.4, 0.6, 0.5}, .path = path};
}

std::string ErrorOf(const std::vector<ActorConfig>& actors, const std::string& room = kPlane) {
  try {
    WorldWith(actors, room);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

Eigen::Vector3d PositionOf(const World& world, const std::string& geom) {
  return Eigen::Vector3d::Map(world.data()->geom_xpos +
                              3 * mj_name2id(world.model(), mjOBJ_GEOM, ("actor_" + geom).c_str()));
}

const BodyMotion& MotionOf(const BodyMotions& motions, const World& world) {
  return motions[static_cast<std::size_t>(mj_name2id(world.model(), mjOBJ_BODY, "actor_cart"))];
}

TEST(Actors, ComeMoveAndGoAtTheirTimes) {
  ActorConfig cart = Box({{0.5, 3, 1}, {1.5, 3, -1}});
  cart.until_s = 2.5;
  const auto world = WorldWith({cart});
  StepFor(*world, 0.498);
  EXPECT_FALSE(world->actors().present(0));
  EXPECT_LT(PositionOf(*world, "cart").z(), -10.0);
  world->Step();
  EXPECT_TRUE(world->actors().present(0));
  StepFor(*world, 0.25);
  EXPECT_LT((PositionOf(*world, "cart") - Eigen::Vector3d(3.0, 0.5, 0.25)).norm(), 1e-9);
  const BodyMotions moving = world->Motions();
  EXPECT_LT((MotionOf(moving, *world).velocity_m_s - Eigen::Vector3d(0, -2, 0)).norm(), 1e-9);
  EXPECT_LT((MotionOf(moving, *world).T_world_body.translation() - Eigen::Vector3d(3.0, 0.5, 0)).norm(), 1e-9);
  StepFor(*world, 1.5);
  EXPECT_LT((PositionOf(*world, "cart") - Eigen::Vector3d(3.0, -1.0, 0.25)).norm(), 1e-9);
  const BodyMotions after = world->Motions();
  EXPECT_TRUE(MotionOf(after, *world).still());
  StepFor(*world, 0.25);
  EXPECT_FALSE(world->actors().present(0));
  EXPECT_LT(PositionOf(*world, "cart").z(), -10.0);
}

TEST(Actors, AreInTheStateWithPoseAndVelocity) {
  const auto world = WorldWith({Box({{0, 3, 1}, {2, 3, -1}})});
  const std::size_t bare = EmptyWorld()->State().size();
  StepFor(*world, 0.5);
  const std::vector<double> state = world->State();
  ASSERT_EQ(state.size(), bare + 13);
  const double half = std::sqrt(0.5);
  const std::vector<double> expected{3, 0.5, 0, half, 0, 0, -half, 0, -1, 0, 0, 0, 0};  // it faces -y
  for (std::size_t i = 0; i < 13; ++i) EXPECT_NEAR(state[bare + i], expected[i], 1e-9) << i;
}

TEST(Actors, LeaveTheCarAsItIsWhileTheyDoNotTouchIt) {
  const auto drive = [](World& world) {
    Send(world, 0.5, 0.1);
    StepFor(world, 2.0);
    std::vector<double> state = world.State();
    state.resize(1 + 14 + 13 + 1);
    return state;
  };
  EXPECT_EQ(drive(*WorldWith({Box({{0, 3, 1}, {2, 3, -1}})})), drive(*EmptyWorld()));
}

TEST(Actors, RunIntoTheCarAndThatIsATouch) {
  const auto world = WorldWith({Box({{0, 3, 0, std::numbers::pi}, {5, 0, 0, std::numbers::pi}})});
  const double gap_m = 3.0 - 0.2 - kFront_m;
  EXPECT_NEAR(world->ActorDistance_m(0, 10.0), gap_m, 1e-3);
  EXPECT_EQ(world->ActorDistance_m(0, 1.0), 1.0);
  while (world->Now() < FromSeconds(5.0) && world->CarTouches().empty()) world->Step();
  ASSERT_FALSE(world->CarTouches().empty());
  EXPECT_EQ(world->CarTouches()[0].other_geom, "actor_cart");
  EXPECT_NEAR(Seconds(world->Now()), gap_m / 0.6, 0.02);  // three metres in five seconds
}

TEST(Actors, WaitWhileTheCarIsNearAheadOfThem) {
  ActorConfig cart = Box({{0, 3, 0, std::numbers::pi}, {5, 0, 0, std::numbers::pi}});
  cart.wait_for_car_m = 0.5;
  const auto world = WorldWith({cart});
  StepFor(*world, 6.0);
  EXPECT_NEAR(world->ActorDistance_m(0, 10.0), 0.5, 0.003);
  EXPECT_TRUE(MotionOf(world->Motions(), *world).still());
  EXPECT_TRUE(world->CarTouches().empty());
  // The car backs away; the actor continues from where it stopped, at the same speed as before.
  Send(*world, -1.0, 0.0);
  StepFor(*world, 1.0);
  const double x_m = PositionOf(*world, "cart").x();
  StepFor(*world, 0.5);
  EXPECT_NEAR(PositionOf(*world, "cart").x(), x_m - 0.6 * 0.5, 1e-9);
  EXPECT_NEAR(MotionOf(world->Motions(), *world).velocity_m_s.x(), -0.6, 1e-9);
}

TEST(Actors, DoNotWaitForACarBehindThem) {
  ActorConfig cart = Box({{0, 0.8, 0}, {1, 2.8, 0}});
  cart.wait_for_car_m = 0.5;
  const auto world = WorldWith({cart});
  EXPECT_LT(world->ActorDistance_m(0, 10.0), 0.5);
  StepFor(*world, 1.0);
  EXPECT_NEAR(PositionOf(*world, "cart").x(), 2.8, 1e-9);
}

TEST(Actors, TakeEveryShapeInItsSizeAndStandOnTheGround) {
  struct Shape {
    std::string name;
    std::vector<double> size_m;
    int type;
    std::vector<double> mujoco;  // half lengths
    double height_m;
  };
  for (const Shape& shape : std::vector<Shape>{{"box", {0.2, 0.4, 0.6}, mjGEOM_BOX, {0.1, 0.2, 0.3}, 0.6},
                                               {"ellipsoid", {0.2, 0.4, 0.6}, mjGEOM_ELLIPSOID, {0.1, 0.2, 0.3}, 0.6},
                                               {"sphere", {0.4}, mjGEOM_SPHERE, {0.2}, 0.4},
                                               {"cylinder", {0.4, 1.0}, mjGEOM_CYLINDER, {0.2, 0.5}, 1.0},
                                               {"capsule", {0.4, 1.0}, mjGEOM_CAPSULE, {0.2, 0.3}, 1.0}}) {
    const auto world = WorldWith(
        {{.name = "it", .shape = shape.name, .size_m = shape.size_m, .material = "white_target", .path = {{0, 2, 1}}}});
    const int geom = mj_name2id(world->model(), mjOBJ_GEOM, "actor_it");
    EXPECT_EQ(world->model()->geom_type[geom], shape.type);
    for (std::size_t i = 0; i < shape.mujoco.size(); ++i)
      EXPECT_NEAR(world->model()->geom_size[3 * geom + static_cast<int>(i)], shape.mujoco[i], 1e-12) << shape.name;
    EXPECT_NEAR(PositionOf(*world, "it").z(), shape.height_m / 2, 1e-12);
    EXPECT_STREQ(mj_id2name(world->model(), mjOBJ_MATERIAL, world->model()->geom_matid[geom]), "white_target");
  }
}

// A wedge. Its corners must be at the positions in the file, moved with the actor.
TEST(Actors, TakeAModelWithBodiesAndAMesh) {
  const TemporaryFile model("wedge.xml", R"(<mujoco><asset>
    <mesh name="wedge" vertex="0 0 0  .4 0 0  0 .3 0  0 0 .5"/><material name="cloth_wool" rgba="1 0 0 1"/></asset>
    <worldbody><geom name="foot" size=".1" pos="0 0 .1" contype="0" conaffinity="0"/>
    <body pos=".1 0 1"><geom name="top" type="mesh" mesh="wedge" material="cloth_wool"/></body></worldbody></mujoco>)");
  const auto world = WorldWith({{.name = "w", .model = model.path(), .path = {{0, 2, 1, std::numbers::pi / 2}}}});
  const mjModel* m = world->model();
  const int foot = mj_name2id(m, mjOBJ_GEOM, "actor_w_foot"), top = mj_name2id(m, mjOBJ_GEOM, "actor_w_top");
  ASSERT_GE(foot, 0);
  ASSERT_GE(top, 0);
  EXPECT_EQ(m->geom_contype[foot], 0);  // only seen, as the model says
  EXPECT_NE(m->geom_contype[top], 0);
  EXPECT_STREQ(mj_id2name(m, mjOBJ_MATERIAL, m->geom_matid[top]), "cloth_wool");
  EXPECT_EQ(m->mat_rgba[4 * m->geom_matid[top]], 1.0f);
  const int mesh = m->geom_dataid[top];
  ASSERT_EQ(m->mesh_vertnum[mesh], 4);
  std::vector<Eigen::Vector3d> missing{{2, 1.1, 1}, {2, 1.5, 1}, {1.7, 1.1, 1}, {2, 1.1, 1.5}};
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(world->data()->geom_xmat + 9 * top);
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d corner =
        R * Eigen::Vector3f::Map(m->mesh_vert + 3 * (m->mesh_vertadr[mesh] + i)).cast<double>() +
        Eigen::Vector3d::Map(world->data()->geom_xpos + 3 * top);
    std::erase_if(missing, [&](const Eigen::Vector3d& expected) { return (expected - corner).norm() < 1e-6; });
  }
  EXPECT_TRUE(missing.empty()) << missing.size() << " corners are elsewhere";
}

TEST(Actors, ShippedModelsStandOnTheGround) {
  for (const std::string name : {"person", "box", "sphere"}) {
    const std::filesystem::path file = std::filesystem::path(MERLIN_SOURCE_DIR) / "models/actors" / (name + ".xml");
    const auto world = WorldWith({{.name = "a", .model = file, .path = {{0, 3, 0}}},
                                  {.name = "b", .model = file, .path = {{0, 3, 2}}}});  // twice: names do not clash
    const int body = mj_name2id(world->model(), mjOBJ_BODY, "actor_a"), first = world->model()->body_geomadr[body];
    double lowest_m = 1.0;
    for (int geom = first; geom < first + world->model()->body_geomnum[body]; ++geom)
      lowest_m = std::min(lowest_m, world->data()->geom_xpos[3 * geom + 2] - world->model()->geom_rbound[geom]);
    EXPECT_LT(lowest_m, 0.01) << name;
    EXPECT_NEAR(world->ActorDistance_m(0, 10.0), 3.0 - kFront_m - 0.2, 0.15) << name;
  }
}

TEST(Actors, RejectEachFaultInOneSentence) {
  const auto expect = [](ActorConfig actor, const std::string& says) {
    actor.where = "x.yaml:7";
    const std::string said = ErrorOf({actor});
    EXPECT_NE(said.find(says), std::string::npos) << said;
    EXPECT_EQ(said.find("x.yaml:7: actor '"), 0u) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect(Box({}), "path: expected one point or more, got none");
  expect(Box({{0, 3}}), "path[0]: expected [t_s, x_m, y_m], then yaw_rad, then z_m, got 2 numbers");
  expect(Box({{0, 3, 0}, {1, 3, 0, 1}}), "path[1]: expected 3 numbers, as the first point has, got 4");
  expect(Box({{0, 3, 0}, {2, 3, 0}, {1, 3, 0}}), "path[2]: expected a time after 2 s, got 1 s");
  expect(Box({{0, 3, 0}, {0, 3, 1}}), "path[1]: expected a time after 0 s");
  expect(Box({{-1, 3, 0}}), "path[0]: expected a time from 0 s on, got -1 s");
  expect(Box({{0, nan, 0}}), "path[0]: expected finite numbers, got nan");
  ActorConfig cart = Box({{3, 3, 0}});
  cart.until_s = 2.0;
  expect(cart, "until_s: expected a time after it appears at 3 s, got 2 s");
  cart = Box({{0, 3, 0}});
  cart.shape = "spere";
  expect(cart, "shape: unknown; did you mean 'sphere'?, got 'spere'");
  cart.shape = "sphere";
  expect(cart, "size_m: expected 1 length for a sphere, got 3");
  cart.size_m = {nan};
  expect(cart, "size_m: expected positive lengths, got nan");
  cart = Box({{0, 3, 0}});
  cart.shape = "capsule", cart.size_m = {0.5, 0.5};
  expect(cart, "expected a capsule higher than its diameter");
  cart = Box({{0, 3, 0}});
  cart.model = "box.xml";
  expect(cart, "model, shape: expected one of the two, got both");
  cart.name = "a b", cart.model.clear();
  expect(cart, "name: expected letters, digits, '_' and '-', got 'a b'");
}

TEST(Actors, RefuseTwoOfOneName) {
  EXPECT_EQ(ErrorOf({Box({{0, 3, 0}}), Box({{0, 3, 2}})}),
            "actor 'cart': name: expected a name of its own, got that of another actor");
}

TEST(Actors, RejectABadModel) {
  const auto error_of = [](const std::string& text) {
    const TemporaryFile model("it.xml", text);
    return ErrorOf({{.name = "it", .model = model.path(), .path = {{0, 3, 0}}}});
  };
  EXPECT_NE(ErrorOf({{.name = "it", .model = "none.xml", .path = {{0, 3, 0}}}}).find("none.xml: no such actor"),
            std::string::npos);
  EXPECT_NE(error_of("<mujoco>\n<worldbody>\n<geom type='ball'/></worldbody></mujoco>").find("it.xml:3"),
            std::string::npos);
  EXPECT_NE(error_of("<mujoco/>").find("the actor has no geoms"), std::string::npos);
  EXPECT_NE(
      error_of("<mujoco><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>").find("cannot be part"),
      std::string::npos);
  EXPECT_NE(error_of("<mujoco><worldbody><body><joint/><geom size='1'/></body></worldbody></mujoco>").find("no joints"),
            std::string::npos);
}

TEST(Actors, RefuseToStartInTheCarAndMayComeIntoItLater) {
  EXPECT_NE(ErrorOf({Box({{0, 0.5, 0}})}).find("actor 'cart': it is present at the start and touches the car"),
            std::string::npos);
  ActorConfig huge = Box({{0, 0, 0}});
  huge.size_m = {5, 5, 5};  // the car is entirely inside
  EXPECT_NE(ErrorOf({huge}).find("actor 'cart': it is present at the start"), std::string::npos);
  const auto world = WorldWith({Box({{0.1, 0.6, 0}})});
  StepFor(*world, 0.1);
  EXPECT_FALSE(world->CarTouches().empty());
}

TEST(Actors, RefuseAPathThatLeavesTheRoom) {
  EXPECT_EQ(ErrorOf({Box({{0, 3, 0}, {1, 5, 5}})}, kHall), "no error");
  EXPECT_EQ(ErrorOf({Box({{0, 3, 0}, {1, 50, 5}})}), "no error");  // an infinite room
  const std::string out = ErrorOf({Box({{0, 3, 0}, {1, 5, 5}, {2, 5, 7}})}, kHall);
  EXPECT_NE(out.find("actor 'cart': its path leaves the room; expected all of it within the outline"),
            std::string::npos)
      << out;
  EXPECT_NE(out.find("path[2] at x 5 m, y 7 m"), std::string::npos) << out;
}

// An L-shaped outline: both points lie inside, but the straight line between them cuts across the notch.
TEST(RoomBox, HoldsALineOnlyIfAllOfItIsWithinTheOutline) {
  const std::vector<Eigen::Vector2d> outline{{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {0, 2}};
  EXPECT_TRUE(HoldsLine(outline, {1, 1}, {3, 1}));
  EXPECT_TRUE(HoldsLine(outline, {3, 1}, {3, 3}));
  EXPECT_TRUE(HoldsLine(outline, {1, 1}, {1, 1}));
  EXPECT_FALSE(HoldsLine(outline, {0.5, 1.8}, {2.2, 3.8}));
  EXPECT_FALSE(HoldsLine(outline, {1, 1}, {1, 3}));
  EXPECT_FALSE(HoldsLine(outline, {5, 1}, {5, 1}));
}

}  // namespace
}  // namespace merlin::sim
