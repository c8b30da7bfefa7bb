#include "sim/drive/drivetrain.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numbers>

#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// Path length and turn of the middle of the rear axle over a time.
struct Travel {
  double path_m = 0.0;
  double turn_rad = 0.0;
};

Travel Drive(World& world, double duration_s) {
  Travel travel;
  const Time end = world.Now() + FromSeconds(duration_s);
  while (world.Now() < end) {
    const Pose before = world.T_world_base();
    world.Step();
    const Pose after = world.T_world_base();
    travel.path_m += (after.translation() - before.translation()).norm();
    travel.turn_rad += WrapPi(Yaw(after) - Yaw(before));
  }
  return travel;
}

double HingeAngle_rad(const World& world, const char* joint) {
  return world.data()->qpos[world.model()->jnt_qposadr[mj_name2id(world.model(), mjOBJ_JOINT, joint)]];
}

// Tests of mechanical laws to a fraction of a percent use ideal electronics; drive_controller_test.cc tests the
// electronics.
class CircleAtSteering : public testing::TestWithParam<double> {};

// Tolerance: the measured error of the tyre model, 0.12 %, plus that of the steering polynomial.
TEST_P(CircleAtSteering, HasAckermannRadiusAtTheRearAxle) {
  const double steering_rad = GetParam() * kDegree;
  const auto world = EmptyWorld(IdealDrivetrain());
  Send(*world, 0.3, steering_rad);
  StepFor(*world, 1.0);
  const Travel travel = Drive(*world, 5.0);
  const double expected_m = Merlin().wheelbase_m / std::tan(steering_rad);
  EXPECT_NEAR(travel.path_m / travel.turn_rad, expected_m, 0.002 * std::abs(expected_m));
}
INSTANTIATE_TEST_SUITE_P(BothSides, CircleAtSteering,
                         testing::Values(-25.0, -20.0, -10.0, -5.0, 5.0, 10.0, 20.0, 25.0));

TEST(Drivetrain, DoesNotDriftAtRest) {
  const auto world = EmptyWorld();
  StepFor(*world, 0.5);  // the tyres settle
  const Pose start = world->T_world_base();
  StepFor(*world, 10.0);
  EXPECT_LT((world->T_world_base().translation() - start.translation()).norm(), 1e-7);
  EXPECT_LT(LogSo3(start.linear().transpose() * world->T_world_base().linear()).norm(), 1e-7);
  EXPECT_EQ(Read(*world).encoder_counts, 0);
}

TEST(Drivetrain, DrivesStraight) {
  for (const double speed_m_s : {1.0, -1.0}) {
    const auto world = EmptyWorld();
    Send(*world, speed_m_s, 0.0);
    StepFor(*world, 5.5);
    EXPECT_NEAR(world->T_world_base().translation().x(), 5.0 * speed_m_s + 0.25 * speed_m_s, 0.02);  // v t - v^2 / 2a
    EXPECT_NEAR(world->T_world_base().translation().y(), 0.0, 1e-6);
    EXPECT_NEAR(Yaw(world->T_world_base()), 0.0, 1e-6);
  }
}

TEST(Drivetrain, HoldsTheSpeedOfTheRearAxlesMiddle) {
  for (const double speed_m_s : {0.05, 0.5, -0.5, 2.0})
    for (const double steering_rad : {0.0, 10 * kDegree, -25 * kDegree}) {
      if (std::abs(speed_m_s) > 1.0 && steering_rad != 0.0) continue;  // would slide
      const auto world = EmptyWorld(IdealDrivetrain());
      Send(*world, speed_m_s, steering_rad);
      StepFor(*world, 2.5);
      // 0.5 %: the slip of the tyres in a turn.
      EXPECT_NEAR(world->Speed_m_s(), speed_m_s, 0.005 * std::abs(speed_m_s))
          << speed_m_s << " m/s at " << steering_rad;
    }
}

TEST(Drivetrain, AcceleratesNoFasterThanTheCarsLimit) {
  const auto world = EmptyWorld(IdealDrivetrain());
  Send(*world, 2.0, 0.0);
  double before_m_s = 0.0;
  while (world->Now() < FromSeconds(1.5)) {
    StepFor(*world, 0.05);
    EXPECT_LT(world->Speed_m_s() - before_m_s, 0.05 * Merlin().drivetrain.acceleration_max_m_s2 * 1.1);
    before_m_s = world->Speed_m_s();
  }
  EXPECT_NEAR(before_m_s, 2.0, 0.01);
}

TEST(Drivetrain, ClampsCommandsToTheCarsLimits) {
  const auto world = EmptyWorld();
  Send(*world, 0.3, 1.5);
  StepFor(*world, 1.0);
  EXPECT_NEAR(Read(*world).steering_rad, Merlin().steering_max_rad, 0.001);
  Send(*world, -1e300, 0.0);
  StepFor(*world, 3.0);
  EXPECT_NEAR(world->Speed_m_s(), -Merlin().drivetrain.speed_max_m_s, 0.01);
}

TEST(Drivetrain, SteersNoFasterThanTheServo) {
  const auto world = EmptyWorld();
  const double slew_rad_s = Merlin().drivetrain.steering_slew_rad_s, goal_rad = Merlin().steering_max_rad;
  Send(*world, 0.0, goal_rad);
  StepFor(*world, 0.5 * goal_rad / slew_rad_s);
  EXPECT_LT(Read(*world).steering_rad, 0.51 * goal_rad);
  EXPECT_GT(Read(*world).steering_rad, 0.20 * goal_rad);
  StepFor(*world, 0.5 * goal_rad / slew_rad_s + 0.1);
  EXPECT_NEAR(Read(*world).steering_rad, goal_rad, 0.01 * goal_rad);
}

// cot(wheel) = cot(middle) -+ track / (2 wheelbase); tolerance: the fit of the quartic, 0.008 deg, and soft joints.
TEST(Drivetrain, FrontWheelsFollowAckermann) {
  const CarDescription car = Merlin();
  const auto world = EmptyWorld(IdealDrivetrain());
  for (const double degrees : {-25.0, -12.0, 3.0, 12.0, 25.0}) {
    Send(*world, 0.2, degrees * kDegree);
    StepFor(*world, 1.0);
    const double middle_rad = Read(*world).steering_rad, offset = 0.5 * car.track_m / car.wheelbase_m;
    EXPECT_NEAR(middle_rad, degrees * kDegree, 0.1 * kDegree);
    const double left_rad = std::atan(1.0 / (1.0 / std::tan(middle_rad) - offset));
    const double right_rad = std::atan(1.0 / (1.0 / std::tan(middle_rad) + offset));
    EXPECT_NEAR(HingeAngle_rad(*world, "steer_front_left_joint"), left_rad, 0.02 * kDegree);
    EXPECT_NEAR(HingeAngle_rad(*world, "steer_front_right_joint"), right_rad, 0.02 * kDegree);
  }
}

struct Expiry {
  double speed_m_s;
  double steering_rad;
};

// Time from now until the car stands still for good; observed for 3 s.
double TimeToStand_s(World& world) {
  const Time start = world.Now();
  Time stands = start;
  while (world.Now() < start + FromSeconds(3.0)) {
    world.Step();
    if (std::abs(world.Speed_m_s()) >= 0.01) stands = world.Now();
  }
  return Seconds(stands - start);
}

TEST(Drivetrain, StandsInTimeAfterExpiry) {
  for (const Expiry& e :
       {Expiry{0.05, 0}, {0.5, 0}, {-0.5, 0}, {0.5, 25 * kDegree}, {1, -5 * kDegree}, {2, 0}, {-2, 0}}) {
    const auto world = EmptyWorld();
    Send(*world, e.speed_m_s, e.steering_rad, 2.0);
    StepFor(*world, 1.998);
    EXPECT_FALSE(Read(*world).expired);
    EXPECT_NEAR(world->Speed_m_s(), e.speed_m_s, 0.01 * std::abs(e.speed_m_s));
    StepFor(*world, 0.002);
    EXPECT_TRUE(Read(*world).expired);
    EXPECT_LE(TimeToStand_s(*world), 0.2 + std::abs(e.speed_m_s) / 2.0) << e.speed_m_s << " m/s at " << e.steering_rad;
  }
}

TEST(Drivetrain, BrakesWithinTheDistanceOfItsDeceleration) {
  const auto world = EmptyWorld();
  Send(*world, 2.0, 0.0, 3.0);
  StepFor(*world, 3.0);
  const double start_m = world->T_world_base().translation().x();
  StepFor(*world, 2.0);
  EXPECT_LT(world->T_world_base().translation().x() - start_m, 2.0 * 2.0 / (2 * 2.0));  // v^2 / 2a at 2 m/s2
}

TEST(Drivetrain, ExpiresAtOnceWhenACommandIsNotFinite) {
  const std::array<DriveCommand, 4> bad = {DriveCommand{kNan, 0.0, FromSeconds(9)},
                                           {0.5, kNan, FromSeconds(9)},
                                           {kInf, 0.0, FromSeconds(9)},
                                           {0.5, -kInf, FromSeconds(9)}};
  for (const DriveCommand& command : bad) {
    const auto world = EmptyWorld();
    Send(*world, 1.0, 0.1);
    StepFor(*world, 2.0);
    world->drive().Send(command, world->Now());
    EXPECT_TRUE(Read(*world).expired);
    EXPECT_LE(TimeToStand_s(*world), 0.2 + 1.0 / 2.0);
    EXPECT_NEAR(Read(*world).steering_rad, 0.1, 0.002);
  }
}

TEST(Drivetrain, KeepsACommandForNoTimeOrForEver) {
  const auto world = EmptyWorld();
  EXPECT_TRUE(Read(*world).expired);  // no command yet
  Send(*world, 1.0, 0.0, 0.0);
  EXPECT_TRUE(Read(*world).expired);
  Send(*world, 1.0, 0.0, -5.0);
  EXPECT_TRUE(Read(*world).expired);
  StepFor(*world, 0.2);
  EXPECT_NEAR(world->Speed_m_s(), 0.0, 1e-6);
  world->drive().Send({.speed_m_s = 1.0, .steering_rad = 0.0, .valid_for = Duration::max()}, world->Now());
  StepFor(*world, 1.0);
  EXPECT_FALSE(Read(*world).expired);
  EXPECT_NEAR(world->Speed_m_s(), 1.0, 0.01);
}

TEST(Drivetrain, EncoderCountsTheStraightPath) {
  for (const double speed_m_s : {0.5, -0.5}) {
    const auto world = EmptyWorld();
    Send(*world, speed_m_s, 0.0);
    StepFor(*world, 4.0);
    const double counted_m = static_cast<double>(Read(*world).encoder_counts) * Merlin().MetresPerCount();
    const double path_m = world->T_world_base().translation().x();
    EXPECT_NEAR(counted_m, path_m, 0.002 * std::abs(path_m));  // the loaded tyre rolls on a slightly smaller radius
    EXPECT_GT(counted_m * speed_m_s, 0.0);
  }
}

// In a turn, the path of each wheel is its distance from the centre of the circle times the turn angle.
TEST(Drivetrain, EncoderCountsTheFourWheelsMeanInATurn) {
  const CarDescription car = Merlin();
  for (const double degrees : {-10.0, 10.0, 25.0}) {
    const auto world = EmptyWorld(IdealDrivetrain());
    Send(*world, 0.3, degrees * kDegree);
    StepFor(*world, 1.0);
    const std::int64_t before = Read(*world).encoder_counts;
    const Travel travel = Drive(*world, 4.0);
    const double radius_m = car.wheelbase_m / std::tan(degrees * kDegree);
    double mean_m = 0.0;
    for (const double x_m : {0.0, car.wheelbase_m})
      for (const double y_m : {-0.5 * car.track_m, 0.5 * car.track_m}) mean_m += 0.25 * std::hypot(x_m, radius_m - y_m);
    const double counted_m = static_cast<double>(Read(*world).encoder_counts - before) * car.MetresPerCount();
    EXPECT_NEAR(counted_m / travel.path_m, mean_m / std::abs(radius_m), 0.003) << degrees;
  }
}

TEST(Drivetrain, DrawsTheCurrentThatAcceleratesTheCar) {
  const CarDescription car = Merlin();
  const auto world = EmptyWorld(IdealDrivetrain());
  Send(*world, 2.0, 0.0);
  StepFor(*world, 0.5);
  // Force on the ground / gear ratio / K; the wheels' and the rotor's inertia (6 %) come on top.
  const double force_n = 6.5 * car.drivetrain.acceleration_max_m_s2;
  const double current_a = force_n * car.wheel_radius_m / car.drivetrain.gear / car.drivetrain.motor_constant_v_s;
  EXPECT_GT(Read(*world).current_a, current_a);
  EXPECT_LT(Read(*world).current_a, 1.3 * current_a);
  EXPECT_EQ(Read(*world).battery_v, 12.0);
  StepFor(*world, 2.0);
  EXPECT_NEAR(Read(*world).current_a, 0.0, 0.1);
}

}  // namespace
}  // namespace merlin::sim
