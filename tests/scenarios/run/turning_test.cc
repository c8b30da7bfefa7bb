// Panned cameras and a car on a turntable, from the twin's world to the stack's points.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "perception/pipeline.h"
#include "robot/base/error.h"
#include "robot/description/description.h"
#include "robot/twin/twin.h"
#include "scenarios/run/plugs.h"
#include "tests/sim/world/car_world.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

std::atomic<bool> never{false};

// Three walls around the car: 3 m ahead of its base and 2 m to its sides.
constexpr char kRoom[] = R"(<geom name="floor" type="plane" size="20 20 1"/>
  <geom name="ahead" type="box" size="0.1 8 2" pos="3.1 0 2"/>
  <geom name="left" type="box" size="8 0.1 2" pos="0 2.1 2"/>
  <geom name="right" type="box" size="8 0.1 2" pos="0 -2.1 2"/>)";

// Distance of a point of the world from the nearest of those walls and the floor.
double FromRoom_m(const Eigen::Vector3d& p) {
  return std::min({std::abs(p.x() - 3.0), std::abs(p.y() - 2.0), std::abs(p.y() + 2.0), std::abs(p.z())});
}

TwinOptions Options(const sim::TemporaryFile& room) {
  TwinOptions options;
  options.world.room = room.path();
  options.world.car = sim::Merlin();
  options.depth.sheet = ReadDepthCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
  options.depth.effects = sim::ParseTofEffects("ideal");
  options.end = std::chrono::minutes(10);
  options.threads = 1;
  return options;
}

Rig RigOf(const Robot& robot) {
  const DepthCameraInfo& depth = robot.depth->Info();
  return {.car = sim::Merlin(),
          .depth = depth.sheet,
          .T_base_depth = depth.T_base_camera,
          .color = std::nullopt,
          .pans = robot.pan != nullptr,
          .on_turntable = robot.turntable != nullptr};
}

// Runs for a while and calls a function with every observation.
template <class See>
void Watch(Twin& twin, double seconds, const See& see) {
  const Robot robot = twin.robot();
  Pipeline pipeline(RigOf(robot), {});
  const Time end = robot.clock->Now() + FromSeconds(seconds);
  while (robot.clock->Now() < end) {
    ASSERT_TRUE(robot.clock->WaitUntil(robot.clock->Now() + std::chrono::milliseconds(50)));
    while (auto state = robot.drive->Poll()) pipeline.Add(*state);
    while (robot.pan) {
      const auto state = robot.pan->Poll();
      if (!state) break;
      pipeline.AddPan(*state);
    }
    while (robot.turntable) {
      const auto state = robot.turntable->Poll();
      if (!state) break;
      pipeline.AddTurntable(*state);
    }
    while (auto frame = robot.depth->Poll())
      if (const auto observation = pipeline.Process(*frame)) see(*observation);
  }
}

// While the cameras turn at full speed, the angle of 20 ms earlier or later would misplace points of the wall by 0.2 m.
TEST(Pan, PutsPointsWhereTheyAreWhileTheCamerasTurn) {
  const sim::TemporaryFile room("room.xml", sim::Room(kRoom));
  TwinOptions options = Options(room);
  options.world.car.pan->moves = true;
  Twin twin(options);
  int points = 0, off = 0, on_the_left = 0, on_the_right = 0;
  for (const double angle_rad : {1.5, -1.5, 0.0}) {
    twin.robot().pan->Send(angle_rad);
    Watch(twin, 1.5, [&](const Observation& observation) {
      for (const Point& point : observation.points_base) {
        const Eigen::Vector3d p = point.position.cast<double>();  // the car is at the origin
        ++points;
        off += FromRoom_m(p) > 0.05;
        on_the_left += std::abs(p.y() - 2.0) < 0.05 && std::abs(p.x()) < 1.0;
        on_the_right += std::abs(p.y() + 2.0) < 0.05 && std::abs(p.x()) < 1.0;
      }
    });
  }
  EXPECT_GT(points, 50000);
  EXPECT_LT(off, points / 200);
  EXPECT_GT(on_the_left, 1000);
  EXPECT_GT(on_the_right, 1000);
}

TEST(Turntable, GivesTheOdometryTheTurnThatTheWheelsDoNotMeasure) {
  const sim::TemporaryFile room("room.xml", sim::Room(kRoom));
  TwinOptions options = Options(room);
  options.world.turntable_rate_rad_s = 1.0;
  Twin twin(options);
  std::vector<std::pair<Time, Pose>> truth;
  const Pose T_world_start = twin.world().T_world_base();
  twin.OnStep([&](sim::World& world) { truth.emplace_back(world.Now(), world.T_world_base()); });
  twin.robot().turntable->Send(-4.0);
  int frames = 0;
  Watch(twin, 4.5, [&](const Observation& observation) {
    const auto at = std::ranges::find(truth, observation.stamp, &std::pair<Time, Pose>::first);
    if (at == truth.end()) return;
    const Pose expected = T_world_start.inverse() * at->second;
    EXPECT_LT((observation.T_odom_base.translation() - expected.translation()).norm(), 0.003);
    EXPECT_NEAR(WrapPi(Yaw(observation.T_odom_base) - Yaw(expected)), 0.0, 0.003);
    ++frames;
  });
  EXPECT_GT(frames, 80);
}

TEST(Turntable, ExistsOnlyInTheTwin) {
  const TemporaryFolder folder;
  RunOptions options{.name = "room_turn_180",
                     .scenario = ReadScenario("room_turn_180", {}),
                     .out = folder.path() / "a",
                     .robot = RobotKind::kEmulated,
                     .gl = Gl::kOff,
                     .threads = 1,
                     .pace = 0.0,
                     .progress = {}};
  EXPECT_THROW(RunScenario(options, never), InputError);
  options.robot = RobotKind::kTwin;
  options.manual = [](Time) { return ManualCommand{}; };
  EXPECT_THROW(RunScenario(options, never), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a"));
}

TEST(Turntable, MapsTheRoomBehindItsCurtainFromOnePlace) {
  const TemporaryFolder folder;
  const RunReport report = RunScenario({.name = "room_turn_360_curtain",
                                        .scenario = ReadScenario("room_turn_360_curtain", {}),
                                        .out = folder.path() / "a",
                                        .gl = Gl::kOff,
                                        .threads = 2,
                                        .pace = 0.0,
                                        .progress = {}},
                                       never);
  const Metrics& m = report.result.metrics;
  EXPECT_EQ(report.result.verdict, Verdict::kPass) << ToJson(report.result);
  EXPECT_EQ(m.collisions, 0);
  EXPECT_LT(*m.distance_m, 0.01);  // it turns on the spot
}

}  // namespace
}  // namespace merlin
