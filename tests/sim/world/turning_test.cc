// Panned cameras, and a car on a turntable.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/pan_servo.h"
#include "sim/world/turntable.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

WorldOptions Options(const TemporaryFile& room) {
  WorldOptions options{.room = room.path(), .car = Merlin(), .T_world_start = FromXyYaw(1.0, 2.0, 0.7)};
  options.car.pan->moves = true;
  return options;
}

void ExpectNear(const Pose& a, const Pose& b, double tolerance) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), tolerance) << a.matrix() << "\n\n" << b.matrix();
}

TEST(PanServo, TurnsTheCamerasThatHangBelowIt) {
  const TemporaryFile room("room.xml", Room(kPlane));
  World world(Options(room));
  world.pan()->Send(0.6);
  StepFor(world, 1.5);
  const double angle_rad = world.pan()->Read_rad(world.data());
  EXPECT_NEAR(angle_rad, 0.6, 0.005);
  // MuJoCo's own kinematics of the optical frame agree.
  const int body = mj_name2id(world.model(), mjOBJ_BODY, "depth_camera_optical_frame");
  Pose T_world_camera = Pose::Identity();
  T_world_camera.translation() = Eigen::Vector3d::Map(world.data()->xpos + 3 * body);
  T_world_camera.linear() = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(world.data()->xmat + 9 * body);
  ExpectNear(world.CameraMotion(Merlin().T_base_depth).T_world_body, T_world_camera, 1e-9);
  EXPECT_NEAR(WrapPi(std::atan2(T_world_camera.linear()(1, 2), T_world_camera.linear()(0, 2)) - 0.7), 0.6, 0.01);
}

TEST(PanServo, MovesACameraAsFiniteDifferencesSay) {
  const TemporaryFile room("room.xml", Room(kPlane));
  World world(Options(room));
  Send(world, 0.5, 0.2);
  StepFor(world, 0.5);
  world.pan()->Send(1.2);
  StepFor(world, 0.2);  // while it turns at full speed
  const BodyMotion before = world.CameraMotion(*Merlin().T_base_color);
  world.Step();
  const BodyMotion after = world.CameraMotion(*Merlin().T_base_color);
  const double step_s = Seconds(World::kStep);
  const Eigen::Vector3d velocity = (after.T_world_body.translation() - before.T_world_body.translation()) / step_s;
  EXPECT_LT((velocity - 0.5 * (before.velocity_m_s + after.velocity_m_s)).norm(), 0.01);
  const Eigen::Vector3d turn = LogSo3(after.T_world_body.linear() * before.T_world_body.linear().transpose()) / step_s;
  EXPECT_GT(turn.z(), 2.0);
  EXPECT_LT((turn - 0.5 * (before.angular_velocity_rad_s + after.angular_velocity_rad_s)).norm(), 0.05);
}

TEST(PanServo, LeavesTheCarWhereItStands) {
  const TemporaryFile room("room.xml", Room(kPlane));
  World world(Options(room));
  StepFor(world, 0.5);
  const Pose before = world.T_world_base();
  for (const double angle_rad : {1.5, -1.5, 0.0}) {
    world.pan()->Send(angle_rad);
    StepFor(world, 1.5);
  }
  EXPECT_LT((world.T_world_base().translation() - before.translation()).norm(), 0.003);
}

TEST(PanServo, IsHeldAheadWhereNobodyAskedForIt) {
  const auto world = MakeWorld(Room(kPlane));
  EXPECT_EQ(world->pan(), nullptr);
  EXPECT_LT(mj_name2id(world->model(), mjOBJ_JOINT, "pan_joint"), 0);
}

TEST(Turntable, GoesThereAtItsRateAndStays) {
  Turntable table(Merlin(), Pose::Identity(), 0.5);
  table.Send(-1.0);
  table.Send(std::nan(""));
  for (int i = 0; i < 500; ++i) table.Step(std::chrono::milliseconds(2));
  EXPECT_NEAR(table.angle_rad(), -0.5, 1e-9);
  EXPECT_NEAR(table.speed_rad_s(), -0.5, 1e-9);
  for (int i = 0; i < 1000; ++i) table.Step(std::chrono::milliseconds(2));
  EXPECT_DOUBLE_EQ(table.angle_rad(), -1.0);
  EXPECT_EQ(table.speed_rad_s(), 0.0);
}

TEST(Turntable, TurnsTheCarAboutItsBaseOffTheFloor) {
  const TemporaryFile room("room.xml", Room(kPlane));
  WorldOptions options = Options(room);
  options.turntable_rate_rad_s = 1.0;
  World world(options);
  const Pose T_world_start = world.T_world_base();
  EXPECT_NEAR(T_world_start.translation().z(), kTurntableHeight_m, 1e-9);
  world.turntable()->Send(2.0 * std::numbers::pi);
  StepFor(world, 0.5 * std::numbers::pi);
  EXPECT_LT((world.T_world_base().translation() - T_world_start.translation()).norm(), 1e-9);
  EXPECT_NEAR(WrapPi(Yaw(world.T_world_base()) - 0.7), 0.5 * std::numbers::pi, 0.003);
  const BodyMotion motion = world.BaseMotion();
  EXPECT_NEAR(motion.angular_velocity_rad_s.z(), 1.0, 1e-9);
  EXPECT_LT(motion.velocity_m_s.norm(), 1e-9);
  // The camera moves on a circle: its velocity is along z x r.
  const BodyMotion camera = world.CameraMotion(Merlin().T_base_depth);
  const Eigen::Vector3d from_axis = camera.T_world_body.translation() - T_world_start.translation();
  EXPECT_LT((camera.velocity_m_s - Eigen::Vector3d::UnitZ().cross(from_axis)).norm(), 1e-3);
  StepFor(world, 6.0);
  ExpectNear(world.T_world_base(), T_world_start, 1e-6);  // after a full turn
  EXPECT_TRUE(world.CarTouches().empty());
  EXPECT_NEAR(static_cast<double>(Read(world).encoder_counts) * Merlin().MetresPerCount(), 0.0, 0.005);
}

}  // namespace
}  // namespace merlin::sim
