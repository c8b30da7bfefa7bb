// The drive with the faults of a real one, in the world, compared with laws whose answers are known.
#include "sim/drive/drive_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/base/error.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180.0;
constexpr double kGravity_m_s2 = 9.81;

int Motor(const World& world) { return mj_name2id(world.model(), mjOBJ_ACTUATOR, "motor"); }
double MotorVolts(const World& world) { return world.data()->ctrl[world.model()->actuator_ctrladr[Motor(world)]]; }
double MotorSpeed_rad_s(const World& world) {
  return world.data()->actuator_velocity[world.model()->actuator_outadr[Motor(world)]];
}

double KineticEnergy_j(const World& world) {
  std::vector<double> momentum(static_cast<std::size_t>(world.model()->nv));
  mj_mulM(world.model(), world.data(), momentum.data(), world.data()->qvel);
  return 0.5 * mju_dot(momentum.data(), world.data()->qvel, world.model()->nv);
}

TEST(DriveAtRest, StandsStillForAMinute) {
  const auto world = EmptyWorld();
  StepFor(*world, 0.5);
  const Pose start = world->T_world_base();
  StepFor(*world, 60.0);
  EXPECT_LT((world->T_world_base().translation() - start.translation()).norm(), 1e-3);
}

TEST(DriveAtRest, StandsStillForAMinuteAfterItHasDriven) {
  const auto world = EmptyWorld();
  Send(*world, 0.5, 0.2, 2.0);
  StepFor(*world, 3.5);
  const Pose start = world->T_world_base();
  StepFor(*world, 60.0);
  EXPECT_LT((world->T_world_base().translation() - start.translation()).norm(), 1e-3);
  EXPECT_LE(std::abs(MotorVolts(*world)), 0.3);  // off, or a correction by one count
}

// Statics: a stalled motor draws V/R, and the wall takes its torque times the gear over the wheel's radius.
TEST(DriveAgainstAWall, DrawsTheStallCurrentAndPushesWithItsTorque) {
  const CarDescription car = Merlin();
  const auto world =
      MakeWorld(Room(std::string(kPlane) + R"(<geom name="wall" type="box" size=".1 2 1" pos=".62 0 1"/>)"));
  Send(*world, 0.1, 0.0);
  StepFor(*world, 0.95);  // at the wall since 0.75 s; from 1.1 s on the integral is so large that the wheels slip
  ASSERT_LT(std::abs(world->Speed_m_s()), 1e-3);
  const DriveState state = Read(*world);
  EXPECT_GT(state.current_a, 3.0);
  EXPECT_NEAR(state.current_a, MotorVolts(*world) / car.drivetrain.resistance_ohm, 0.02 * state.current_a);
  const std::unique_ptr<mjData, void (*)(mjData*)> now(mj_copyData(nullptr, world->model(), world->data()),
                                                       mj_deleteData);
  mj_forward(world->model(), now.get());  // the forces of exactly this state
  double push_n = 0.0;
  for (int i = 0; i < now->ncon; ++i) {
    mjtNum force[6];
    mj_contactForce(world->model(), now.get(), i, force);
    if (std::abs(now->contact[i].frame[0]) > 0.9) push_n += force[0];  // along x: from the wall
  }
  const double expected_n =
      state.current_a * car.drivetrain.motor_constant_v_s * car.drivetrain.gear / car.wheel_radius_m;
  EXPECT_NEAR(push_n, expected_n, 0.05 * expected_n);
}

// With all four wheels sliding, the car's speed changes by mu g, whatever the motor does.
TEST(DriveOnASlipperyFloor, AcceleratesAndBrakesWithMuG) {
  const TemporaryFile room("room.xml", Room(kPlane));
  WorldOptions options{.room = room.path(), .car = Merlin()};
  options.materials.by_name["ice"] = {.grip = 0.1};
  options.drivetrain.surface = "ice";
  World world(options);
  const double mu_g_m_s2 = 0.1 * options.car.drivetrain.tyre_friction * kGravity_m_s2;
  Send(world, 0.5, 0.0, 1.5);
  StepFor(world, 0.3);
  EXPECT_NEAR(world.Speed_m_s(), mu_g_m_s2 * 0.3, 0.05 * mu_g_m_s2 * 0.3);
  StepFor(world, 1.2);
  const double speed_m_s = world.Speed_m_s(), start_m = world.T_world_base().translation().x();
  EXPECT_NEAR(speed_m_s, 0.5, 0.01);
  StepFor(world, 1.5);  // the command has expired: the wheels lock
  const double braking_m = world.T_world_base().translation().x() - start_m;
  EXPECT_NEAR(braking_m, speed_m_s * speed_m_s / (2.0 * mu_g_m_s2), 0.05 * braking_m);
}

TEST(DriveOnASlipperyFloor, RefusesASurfaceThatIsNoMaterial) {
  const TemporaryFile room("room.xml", Room(kPlane));
  WorldOptions options{.room = room.path(), .car = Merlin()};
  options.materials.by_name["floor_wet"] = {.grip = 0.4};
  options.drivetrain.surface = "floor_wett";
  try {
    World world(options);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'floor_wet'"), std::string::npos) << error.what();
  }
}

TEST(DriveEnergy, IsNeverMoreThanTheBatteryGave) {
  const CarDescription car = Merlin();
  const auto world = EmptyWorld();
  const double resistance_ohm = car.drivetrain.resistance_ohm;
  double motor_j = 0.0, heat_j = 0.0, fed_back_j = 0.0;
  const auto drive = [&](double speed_m_s, double seconds) {
    Send(*world, speed_m_s, 0.0);
    for (const Time end = world->Now() + FromSeconds(seconds); world->Now() < end;) {
      const double before_rad_s = MotorSpeed_rad_s(*world);
      world->Step();
      // Mean speed over the step, because the torque acts on the way between the two states.
      const double speed_rad_s = 0.5 * (before_rad_s + MotorSpeed_rad_s(*world));
      const double current_a = (MotorVolts(*world) - car.drivetrain.motor_constant_v_s * speed_rad_s) / resistance_ohm;
      motor_j += MotorVolts(*world) * current_a * 0.002;
      fed_back_j += std::max(0.0, -MotorVolts(*world) * current_a * 0.002);
      heat_j += current_a * current_a * resistance_ohm * 0.002;
      // 2 %: the wheels' and the motor's turning within a step.
      EXPECT_LE(KineticEnergy_j(*world) + heat_j, motor_j + 0.02 * (motor_j + fed_back_j) + 1e-3);
    }
  };
  drive(1.5, 2.0);
  const double driving_j = motor_j;
  EXPECT_NEAR(motor_j - heat_j, KineticEnergy_j(*world), 0.05 * motor_j);  // straight ahead nothing else uses energy
  const double ripple_j = fed_back_j;                                      // from the ripple of the speed loop
  drive(0.0, 2.0);
  EXPECT_GT(fed_back_j - ripple_j, 1.0);           // braking gives some back,
  EXPECT_LT(motor_j, driving_j);                   // so that less is spent,
  EXPECT_GT(motor_j, 0.0);                         // but not all of it
  EXPECT_NEAR(motor_j, heat_j, 0.05 * driving_j);  // at rest all of it is heat
}

TEST(DriveBattery, SagsUnderTheLoadAndRecovers) {
  const BatteryConfig battery;
  const auto world = EmptyWorld();
  StepFor(*world, 0.1);
  const double rest_v = Read(*world).battery_v;
  EXPECT_NEAR(rest_v, 12.0 * 1.17 - battery.resistance_ohm * battery.load_a, 0.005);
  Send(*world, 2.0, 0.0);
  StepFor(*world, 0.8);
  const DriveState state = Read(*world);
  const double duty = MotorVolts(*world) / state.battery_v;
  EXPECT_NEAR(rest_v - state.battery_v, battery.resistance_ohm * duty * state.current_a, 0.01);
  EXPECT_LT(state.battery_v, rest_v - 0.05);
}

TEST(DriveBattery, GivesTheMotorNothingOnceItIsEmpty) {
  DrivetrainConfig config;
  config.battery.capacity_ah = 0.001;  // 3.6 As: 1.5 A for 2.4 s, less what the motor takes
  const auto world = EmptyWorld(config);
  Send(*world, 0.5, 0.0);
  StepFor(*world, 1.0);
  EXPECT_NEAR(world->Speed_m_s(), 0.5, 0.02);
  StepFor(*world, 3.0);
  EXPECT_TRUE(world->drive().battery().empty());
  EXPECT_LT(std::abs(world->Speed_m_s()), 0.01);
  EXPECT_EQ(MotorVolts(*world), 0.0);
  EXPECT_NEAR(Read(*world).battery_v, 0.83 * 12.0, 1e-9);
  EXPECT_FALSE(Read(*world).expired);
}

TEST(DriveEncoder, CountsThePathWithinThePlayOfTheGear) {
  for (const double speed_m_s : {0.5, -0.5, 1.5}) {
    const auto world = EmptyWorld();
    Send(*world, speed_m_s, 0.0, 4.0);
    StepFor(*world, 6.0);
    const double counted_m = static_cast<double>(Read(*world).encoder_counts) * Merlin().MetresPerCount();
    const double path_m = world->T_world_base().translation().x();
    const double play_m = DrivetrainConfig{}.gear_backlash_rad / Merlin().drivetrain.gear * Merlin().wheel_radius_m;
    EXPECT_NEAR(counted_m, path_m, 0.002 * std::abs(path_m) + play_m);
    EXPECT_NEAR(std::abs(path_m), std::abs(speed_m_s) * 4.0, 0.05 * std::abs(speed_m_s) * 4.0);
  }
}

TEST(DriveSpeedLoop, HoldsTheMeanSpeedFromCountsAlone) {
  for (const double speed_m_s : {0.05, 0.5, -0.5, 1.5}) {
    const auto world = EmptyWorld();
    Send(*world, speed_m_s, 0.0);
    StepFor(*world, 2.5);
    const double start_m = world->T_world_base().translation().x();
    for (int i = 0; i < 1000; ++i) {
      world->Step();
      // The loop cannot resolve less than a count in 10 ms, which is 7 mm/s.
      EXPECT_NEAR(world->Speed_m_s(), speed_m_s, 0.01 * std::abs(speed_m_s) + 0.007);
    }
    EXPECT_NEAR((world->T_world_base().translation().x() - start_m) / 2.0, speed_m_s,
                0.005 * std::abs(speed_m_s) + 2e-4);
  }
}

// A step of the command between two pulses has no effect until the next pulse; then the servo slews and holds the
// angle.
TEST(DriveServo, StepResponseWaitsForThePulseAndRisesWithTheSlew) {
  DrivetrainConfig config{.steering_backlash_rad = 0.0};
  const auto world = EmptyWorld(config);
  StepFor(*world, 0.502);  // the pulse of 0.500 s has just gone
  Send(*world, 0.0, 20 * kOneDegree);
  while (world->Now() < FromSeconds(0.520)) {
    world->Step();
    EXPECT_NEAR(Read(*world).steering_rad, 0.0, 1e-4) << Seconds(world->Now());
  }
  const double slew_rad_s = Merlin().drivetrain.steering_slew_rad_s;
  StepFor(*world, 0.03);
  const double early_rad = Read(*world).steering_rad;
  StepFor(*world, 0.05);
  EXPECT_NEAR((Read(*world).steering_rad - early_rad) / 0.05, slew_rad_s, 0.05 * slew_rad_s);
  StepFor(*world, 0.2);
  EXPECT_NEAR(Read(*world).steering_rad, 20 * kOneDegree, 0.1 * kOneDegree);
}

double CircleRadius_m(World& world, double steering_rad) {
  Send(world, 0.3, steering_rad);
  StepFor(world, 1.0);
  double path_m = 0.0, turn_rad = 0.0;
  for (int i = 0; i < 2500; ++i) {
    const Pose before = world.T_world_base();
    world.Step();
    path_m += (world.T_world_base().translation() - before.translation()).norm();
    turn_rad += WrapPi(Yaw(world.T_world_base()) - Yaw(before));
  }
  return path_m / turn_rad;
}

TEST(TrueCar, DrivesTheCirclesOfItsOwnWheelbaseAndOffset) {
  const double wheelbase_m = Merlin().wheelbase_m;
  for (const double degrees : {-15.0, 15.0}) {
    DrivetrainConfig config = IdealDrivetrain();
    config.ideal = false;
    config.wheelbase_factor = 1.05;
    config.steering_offset_rad = 0.02;
    const auto world = EmptyWorld(config);
    const double expected_m = 1.05 * wheelbase_m / std::tan(degrees * kOneDegree + 0.02);
    EXPECT_NEAR(CircleRadius_m(*world, degrees * kOneDegree), expected_m, 0.005 * std::abs(expected_m));
    EXPECT_NEAR(Read(*world).steering_rad, degrees * kOneDegree, 0.1 * kOneDegree);  // the servo does not know
  }
}

// A larger wheel travels farther for the same counts.
TEST(TrueCar, RollsOnItsOwnWheels) {
  for (const double factor : {0.97, 1.02}) {
    const auto world = EmptyWorld({.wheel_radius_factor = factor});
    Send(*world, 0.5, 0.0, 4.0);
    StepFor(*world, 5.0);
    const double counted_m = static_cast<double>(Read(*world).encoder_counts) * Merlin().MetresPerCount();
    EXPECT_NEAR(world->T_world_base().translation().x() / counted_m, factor, 0.002);
    EXPECT_NEAR(world->T_world_base().translation().z(), (factor - 1.0) * Merlin().wheel_radius_m, 5e-4);
  }
}

TEST(DriveBits, AreTheSameForTheSameSeedWithEveryFault) {
  const auto end_state = [](std::uint64_t seed) {
    const TemporaryFile room("room.xml", Room(kPlane));
    WorldOptions options{.room = room.path(), .car = Merlin()};
    options.drivetrain.missed_counts = 0.02;
    options.seed = seed;
    World world(options);
    Send(world, 0.7, 0.2);
    StepFor(world, 2.0);
    return world.State();
  };
  EXPECT_EQ(end_state(1), end_state(1));
  EXPECT_NE(end_state(1), end_state(2));
}

TEST(DrivetrainConfig, NamesEveryFaultAtOnce) {
  DrivetrainConfig config;
  config.speed_loop_s = std::nan("");
  config.battery.charge = 1.5;
  try {
    EmptyWorld(config);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("drivetrain.speed_loop_s: expected a number in [0, 0.05], got nan"), std::string::npos) << said;
    EXPECT_NE(said.find("drivetrain.battery.charge"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace merlin::sim
