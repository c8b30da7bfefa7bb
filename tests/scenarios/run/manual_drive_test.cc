// The car driven by hand in the twin, from the joystick's bytes to the wheels.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "robot/description/description.h"
#include "robot/hardware/operator/joystick_device.h"
#include "robot/twin/twin.h"
#include "scenarios/run/drive_loop.h"
#include "tests/sim/world/car_world.h"
#include "tests/support/joystick_pipe.h"
#include "tests/support/temporary_folder.h"
#include "tools/drive/stick.h"

namespace merlin {
namespace {

std::atomic<bool> never{false};
constexpr std::int16_t kFull = 32767;

// A facing wall, and two along the path: a corridor of 2 m that ends.
constexpr char kRoom[] = R"(<geom name="floor" type="plane" size="20 20 1"/>
  <geom name="end" type="box" size="0.1 5 2" pos="6.1 0 2"/>
  <geom name="left" type="box" size="8 0.1 2" pos="0 1.1 2"/>
  <geom name="right" type="box" size="8 0.1 2" pos="0 -1.1 2"/>)";

// One drive: a script moves the stick at given run times; the state is recorded at every tick.
class ManualDrive : public ::testing::Test {
 protected:
  struct Moment {
    double t_s, x_m, speed_m_s, yaw_rad, steering_rad;
    Driver driver;
  };

  ManualDrive()
      : room_("room.xml", sim::Room(kRoom)), pipe_(folder_.path() / "js"), device_(pipe_.path()), stick_(Limits()) {
    const auto models = std::filesystem::path(MERLIN_SOURCE_DIR) / "models";
    options_.world.room = room_.path();
    options_.world.car = sim::Merlin();
    options_.depth.sheet = ReadDepthCameraSheet(models / "cameras/pmd_3k_s.yaml");
    options_.compass = TwinOptions::Compass{};
    options_.threads = 1;
    pipe_.Open();
  }
  static HandLimits Limits() { return {.speed_m_s = 0.8, .steering_rad = sim::Merlin().steering_max_rad}; }

  LoopEnd Drive(double seconds, const std::map<double, std::function<void()>>& script) {
    options_.end = FromSeconds(seconds);
    Twin twin(options_);
    DriveLoop loop(twin.robot(), options_.world.car, {}, {}, {}, {});
    auto next = script.begin();
    const ManualInput manual = [&](Time now) {
      for (; next != script.end() && Seconds(now) >= next->first; ++next) next->second();
      const bool there = device_.Read();
      return stick_.Update(device_.state(), there, now);
    };
    const auto watch = [&](const LoopState& state) {
      const Pose T_world_base = twin.world().T_world_base();
      moments_.push_back({Seconds(state.now), T_world_base.translation().x(), twin.world().Speed_m_s(),
                          Yaw(T_world_base), state.drive.steering_rad, state.arbitration.driver});
      return true;
    };
    return loop.Run(never, watch, manual);
  }
  const Moment& At(double t_s) const {
    return *std::ranges::find_if(moments_, [=](const Moment& moment) { return moment.t_s >= t_s; });
  }

  TemporaryFolder folder_;
  sim::TemporaryFile room_;
  JoystickPipe pipe_;
  JoystickDevice device_;
  Stick stick_;
  TwinOptions options_;
  std::vector<Moment> moments_;
};

TEST_F(ManualDrive, FollowsTheStickAndStandsWhenItIsLetGo) {
  Drive(5.0, {{0.5, [&] { pipe_.Axis(1, -kFull); }},
              {1.8, [&] { pipe_.Axis(0, -kFull / 2); }},
              {2.2, [&] { pipe_.Axis(1, 0), pipe_.Axis(0, 0); }},
              {3.5, [&] { pipe_.Axis(1, kFull); }}});
  EXPECT_NEAR(At(0.45).speed_m_s, 0.0, 1e-3);
  EXPECT_EQ(At(0.45).driver, Driver::kNobody);
  EXPECT_NEAR(At(1.75).speed_m_s, 0.8, 0.05);
  EXPECT_EQ(At(1.75).driver, Driver::kManual);
  EXPECT_GT(At(2.15).steering_rad, 0.1);
  EXPECT_GT(At(2.15).yaw_rad, 0.02) << "stick to the left, car to the left";
  // A tick of delay, then from 0.8 m/s at 2 m/s2.
  EXPECT_NEAR(At(2.8).speed_m_s, 0.0, 0.01);
  EXPECT_EQ(At(2.8).driver, Driver::kNobody);
  EXPECT_LT(At(4.5).speed_m_s, -0.7) << "stick back, car back";
}

TEST_F(ManualDrive, StandsWithinHalfASecondAndItsBrakingOnceTheStickHasGone) {
  Drive(4.0, {{0.5, [&] { pipe_.Axis(1, -kFull); }}, {2.0, [&] { pipe_.Close(); }}});
  EXPECT_NEAR(At(1.9).speed_m_s, 0.8, 0.05);
  EXPECT_NEAR(At(2.0 + 0.5 + 0.8 / 2.0 + 0.15).speed_m_s, 0.0, 0.01);
}

TEST_F(ManualDrive, StopsBeforeTheWallUnlessItIsOverridden) {
  Drive(14.0, {{0.5, [&] { pipe_.Axis(1, -kFull); }},
               {11.0, [&] { pipe_.Button(Stick::kOverrideButton, true); }},
               {11.6, [&] { pipe_.Button(Stick::kOverrideButton, false); }}});
  // The wall is at 6.0 m; the car keeps half a metre between it and the bumper.
  const double front_m = FootprintOf(sim::Merlin()).front_m;
  EXPECT_NEAR(At(10.9).speed_m_s, 0.0, 0.01);
  EXPECT_EQ(At(10.9).driver, Driver::kObstacleStop);
  EXPECT_NEAR(At(10.9).x_m + front_m, 5.5, 0.15);
  EXPECT_GT(At(11.55).x_m, At(10.9).x_m + 0.05) << "overridden on purpose";
  EXPECT_NEAR(At(13.5).speed_m_s, 0.0, 0.01);
  EXPECT_LT(At(13.5).x_m + front_m, 6.0);
}

TEST_F(ManualDrive, GivesTheWheelToThePilotAndTakesItBack) {
  Drive(9.0, {{0.5, [&] { pipe_.Button(Stick::kAutonomyButton, true); }},
              {0.6, [&] { pipe_.Button(Stick::kAutonomyButton, false); }},
              {5.0, [&] { pipe_.Axis(1, kFull); }},
              {6.5, [&] { pipe_.Axis(1, 0); }},
              {8.0, [&] { pipe_.Close(); }}});
  EXPECT_EQ(At(4.5).driver, Driver::kAutonomy);
  EXPECT_NEAR(At(4.5).speed_m_s, FollowCorridorConfig{}.speed_m_s, 0.05);
  EXPECT_EQ(At(6.4).driver, Driver::kManual);
  EXPECT_LT(At(6.4).speed_m_s, -0.5);
  EXPECT_EQ(At(7.9).driver, Driver::kAutonomy);
  EXPECT_GT(At(7.9).speed_m_s, 0.3);
  EXPECT_EQ(At(8.9).driver, Driver::kNobody) << "without a stick nobody could take over";
}

TEST_F(ManualDrive, EndsWhenTheOperatorQuitsOnceTheCarStands) {
  EXPECT_EQ(
      Drive(20.0, {{0.5, [&] { pipe_.Axis(1, -kFull); }}, {2.0, [&] { pipe_.Button(Stick::kQuitButton, true); }}}),
      LoopEnd::kQuit);
  EXPECT_LT(moments_.back().t_s, 2.2);
}

TEST_F(ManualDrive, LeavesThePilotAloneOutOfAnEmptyBattery) {
  options_.world.drivetrain.battery = {.capacity_ah = 0.05, .charge = 0.03};
  EXPECT_EQ(Drive(6.0, {{0.5, [&] { pipe_.Button(Stick::kAutonomyButton, true); }},
                        {3.5, [&] { pipe_.Axis(1, -kFull / 2); }}}),
            LoopEnd::kTimeUp);
  EXPECT_EQ(At(3.4).driver, Driver::kNobody);
  EXPECT_EQ(At(4.0).driver, Driver::kManual) << "whoever drives by hand may bring it home";
}

}  // namespace
}  // namespace merlin
