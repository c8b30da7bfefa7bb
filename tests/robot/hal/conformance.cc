#include "tests/robot/hal/conformance.h"

#include <cmath>
#include <limits>
#include <vector>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(10);

// Runs the robot for a while with one command renewed at every tick, and keeps what its devices hand out.
struct Session {
  explicit Session(const Plug& plug) : rig(plug.make()), robot(rig->robot()) {}

  void Drive(double seconds, std::optional<DriveCommand> command) {
    const Time end = robot.clock->Now() + FromSeconds(seconds);
    while (robot.clock->Now() < end) {
      if (command) robot.drive->Send(*command);
      ASSERT_TRUE(robot.clock->WaitUntil(robot.clock->Now() + kTick));
      while (auto m = robot.depth->Poll()) depth.push_back(*m), depth_seen.push_back(robot.clock->Now());
      while (auto m = robot.drive->Poll()) drive.push_back(*m);
      if (robot.compass)
        while (auto m = robot.compass->Poll()) compass.push_back(*m);
      if (robot.color)
        while (auto m = robot.color->Poll()) color.push_back(*m);
      if (robot.pan)
        while (auto m = robot.pan->Poll()) pan.push_back(*m);
    }
  }
  double Metres(std::int64_t counts) { return static_cast<double>(counts) * rig->car().MetresPerCount(); }

  std::unique_ptr<Rigged> rig;
  Robot robot;
  std::uint64_t delivered_before = robot.depth->Status().delivered;
  std::vector<DepthFrame> depth;
  std::vector<Time> depth_seen;
  std::vector<DriveState> drive;
  std::vector<CompassReading> compass;
  std::vector<ColorFrame> color;
  std::vector<PanState> pan;
};

DriveCommand Go(double speed_m_s, double steering_rad, double valid_s = 0.3) {
  return {.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = FromSeconds(valid_s)};
}

template <class Measurement>
void ExpectAscendingStampsAtRate(const std::vector<Measurement>& measurements, double rate_hz, double seconds) {
  ASSERT_GE(measurements.size(), 2u);
  for (std::size_t i = 1; i < measurements.size(); ++i) EXPECT_GT(measurements[i].stamp, measurements[i - 1].stamp);
  EXPECT_NEAR(static_cast<double>(measurements.size()), rate_hz * seconds, 0.1 * rate_hz * seconds + 2.0);
  const double mean_period_s =
      Seconds(measurements.back().stamp - measurements.front().stamp) / static_cast<double>(measurements.size() - 1);
  EXPECT_NEAR(mean_period_s * rate_hz, 1.0, 0.02);
}

TEST_P(HalConformance, DeliversAtItsRatesInOrderOfStamps) {
  Session session(GetParam());
  session.Drive(3.0, std::nullopt);
  ExpectAscendingStampsAtRate(session.depth, session.robot.depth->Info().rate_hz, 3.0);
  if (session.robot.color) ExpectAscendingStampsAtRate(session.color, session.robot.color->Info().rate_hz, 3.0);
  ASSERT_GE(session.drive.size(), 2u);
  for (std::size_t i = 1; i < session.drive.size(); ++i) EXPECT_GT(session.drive[i].stamp, session.drive[i - 1].stamp);
}

// Supervision and the pre-flight check rely on these rates (autonomy/supervise.h, scenarios/run/preflight.h).
TEST_P(HalConformance, TellsInItsStatusTheRateAtWhichItDelivers) {
  Session session(GetParam());
  session.Drive(3.0, std::nullopt);
  const auto expect = [](const DeviceStatus& status, std::size_t count) {
    EXPECT_GT(status.rate_hz, 0.0);
    EXPECT_NEAR(static_cast<double>(count) / 3.0, status.rate_hz, 0.2 * status.rate_hz);
  };
  expect(session.robot.depth->Status(), session.depth.size());
  expect(session.robot.drive->Status(), session.drive.size());
  if (session.robot.color) expect(session.robot.color->Status(), session.color.size());
  if (session.robot.compass) expect(session.robot.compass->Status(), session.compass.size());
  if (session.robot.pan) expect(session.robot.pan->Status(), session.pan.size());
}

TEST_P(HalConformance, HandsEachMeasurementOutOnceAndCountsIt) {
  Session session(GetParam());
  session.Drive(1.0, std::nullopt);
  if (session.rig->slack() == Duration(0)) {
    EXPECT_FALSE(session.robot.depth->Poll());
  }
  EXPECT_EQ(session.robot.depth->Status().delivered, session.delivered_before + session.depth.size());
  EXPECT_EQ(session.robot.depth->Status().health, DeviceStatus::Health::kOk);
}

TEST_P(HalConformance, CountsWhatASlowReaderMissed) {
  Session session(GetParam());
  ASSERT_TRUE(session.robot.clock->WaitUntil(session.robot.clock->Now() + std::chrono::seconds(4)));
  std::uint64_t taken = 0;
  while (session.robot.depth->Poll()) ++taken;
  const double produced = 4.0 * session.robot.depth->Info().rate_hz;
  EXPECT_NEAR(static_cast<double>(taken + session.robot.depth->Status().missed), produced, 3.0);
  EXPECT_GT(session.robot.depth->Status().missed, 0u);
}

TEST_P(HalConformance, StampsTheMiddleOfTheExposureNotTheArrival) {
  Session session(GetParam());
  session.Drive(1.0, std::nullopt);
  const double latency_s = session.robot.depth->Info().sheet.latency_s;
  for (std::size_t i = 0; i < session.depth.size(); ++i) {
    EXPECT_GE(Seconds(session.depth_seen[i] - session.depth[i].stamp), latency_s - 1e-9);
    EXPECT_LE(Seconds(session.depth_seen[i] - session.depth[i].stamp),
              latency_s + Seconds(kTick + session.rig->slack()) + 0.005);
  }
}

TEST_P(HalConformance, SeesTheWallAheadInMetresAlongTheRays) {
  Session session(GetParam());
  session.Drive(0.5, std::nullopt);
  ASSERT_FALSE(session.depth.empty());
  const DepthFrame& frame = session.depth.back();
  const DepthCameraInfo& info = session.robot.depth->Info();
  const CameraModel& camera = info.sheet.camera;
  ASSERT_EQ(frame.size(), static_cast<std::size_t>(camera.width) * camera.height);
  EXPECT_EQ(frame.amplitude.size(), frame.size());
  EXPECT_EQ(frame.intensity.size(), frame.size());
  EXPECT_EQ(frame.flags.size(), frame.size());
  // The middle pixels look straight ahead: +x of the body.
  const Eigen::Vector3d axis_base = info.T_base_camera.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(axis_base.x(), 1.0, 1e-6);
  const std::size_t middle = static_cast<std::size_t>(camera.height / 2) * camera.width + camera.width / 2;
  EXPECT_NEAR(frame.range_m[middle], session.rig->wall_ahead_m() - info.T_base_camera.translation().x(), 0.1);
  // Rows run downwards: the lowest row meets the floor first, nearer than the wall.
  const std::size_t lowest = static_cast<std::size_t>(camera.height - 1) * camera.width + camera.width / 2;
  EXPECT_LT(frame.range_m[lowest], frame.range_m[middle] - 0.5);
}

TEST_P(HalConformance, RefusesSettingsOutsideTheSheet) {
  Session session(GetParam());
  const DepthCameraSheet& sheet = session.robot.depth->Info().sheet;
  EXPECT_THROW(session.robot.depth->Configure({sheet.integration_max_s * 2.0, sheet.frequencies_hz[0]}), InputError);
  EXPECT_THROW(session.robot.depth->Configure({sheet.integration_min_s, 1.0}), InputError);
  EXPECT_THROW(session.robot.depth->Configure({std::nan(""), sheet.frequencies_hz[0]}), InputError);
}

TEST_P(HalConformance, RefusesColourSettingsOutsideTheSheet) {
  Session session(GetParam());
  if (session.robot.color == nullptr) GTEST_SKIP() << "no colour camera";
  const ColorCameraSheet& sheet = session.robot.color->Info().sheet;
  EXPECT_THROW(session.robot.color->Configure({.exposure_s = 2.0 * sheet.exposure_max_s}), InputError);
  EXPECT_THROW(session.robot.color->Configure({.exposure_s = std::nan("")}), InputError);
  EXPECT_THROW(session.robot.color->Configure({.exposure_s = sheet.exposure_min_s, .gain = 0.5}), InputError);
  EXPECT_THROW(session.robot.color->Configure({.exposure_s = sheet.exposure_min_s, .white_balance_red = 0.0}),
               InputError);
}

TEST_P(HalConformance, UsesNewColourSettingsAndReportsThem) {
  Session session(GetParam());
  if (session.robot.color == nullptr) GTEST_SKIP() << "no colour camera";
  const ColorCameraSheet sheet = session.robot.color->Info().sheet;
  const ColorSettings settings{.exposure_s = 2.0 * sheet.exposure_min_s, .auto_exposure = false};
  session.robot.color->Configure(settings);
  session.Drive(1.0, std::nullopt);
  ASSERT_FALSE(session.color.empty());
  EXPECT_EQ(session.color.back().settings, settings);
  EXPECT_EQ(session.color.back().bgr.size(), 3 * static_cast<std::size_t>(sheet.camera.width) * sheet.camera.height);
}

TEST_P(HalConformance, UsesNewSettingsFromTheNextExposureOn) {
  Session session(GetParam());
  const DepthCameraSheet sheet = session.robot.depth->Info().sheet;
  const DepthSettings settings{2.0 * sheet.integration_min_s, sheet.frequencies_hz[0]};
  session.robot.depth->Configure(settings);
  session.Drive(1.0, std::nullopt);
  EXPECT_DOUBLE_EQ(session.depth.back().settings.integration_s, settings.integration_s);
}

TEST_P(HalConformance, CountsForwardsUpAndBackwardsDownInTrueMetres) {
  Session session(GetParam());
  session.Drive(0.5, Go(0.0, 0.0));
  const std::int64_t start = session.drive.back().encoder_counts;
  session.Drive(2.0, Go(0.5, 0.0));
  session.Drive(1.0, Go(0.0, 0.0));
  const double forth_m = session.Metres(session.drive.back().encoder_counts - start);
  EXPECT_NEAR(forth_m, 1.0, 0.12);  // 0.5 m/s for 2 s, less the ramps' lag
  session.Drive(2.0, Go(-0.5, 0.0));
  session.Drive(1.0, Go(0.0, 0.0));
  EXPECT_NEAR(session.Metres(session.drive.back().encoder_counts - start), 0.0, 0.05);
  // The camera confirms the metres: the wall is where it was.
  const CameraModel& camera = session.robot.depth->Info().sheet.camera;
  const std::size_t middle = static_cast<std::size_t>(camera.height / 2) * camera.width + camera.width / 2;
  EXPECT_NEAR(session.depth.back().range_m[middle], session.depth.front().range_m[middle], 0.1);
}

TEST_P(HalConformance, SteersLeftForPositiveAnglesAndTurnsCounterClockwise) {
  Session session(GetParam());
  session.Drive(1.0, Go(0.0, 0.2));
  EXPECT_NEAR(session.drive.back().steering_rad, 0.2, 0.02);
  if (session.robot.compass == nullptr) GTEST_SKIP() << "no compass";
  session.Drive(1.5, Go(0.4, 0.2));
  const double turned_rad = std::remainder(session.compass.back().yaw_rad - session.rig->start_yaw_rad(), 2.0 * M_PI);
  const double expected_rad = 0.55 * std::tan(0.2) / session.rig->car().wheelbase_m;  // about 0.55 m of path
  EXPECT_NEAR(turned_rad, expected_rad, 0.12 * expected_rad + 4.0 * session.rig->compass_sigma_rad());
}

TEST_P(HalConformance, GivesYawInTheWorldAndALevelAttitude) {
  Session session(GetParam());
  if (session.robot.compass == nullptr) GTEST_SKIP() << "no compass";
  session.Drive(2.0, std::nullopt);
  ASSERT_GE(session.compass.size(), 10u);
  const double tolerance_rad = 5.0 * session.rig->compass_sigma_rad() + 1e-3;
  for (const CompassReading& reading : session.compass) {
    EXPECT_NEAR(std::remainder(reading.yaw_rad - session.rig->start_yaw_rad(), 2.0 * M_PI), 0.0, tolerance_rad);
    EXPECT_NEAR(reading.roll_rad, 0.0, tolerance_rad);
    EXPECT_NEAR(reading.pitch_rad, 0.0, tolerance_rad);
  }
}

// Speed from encoder counts over the last hundred milliseconds.
double Speed_m_s(Session& session) {
  const DriveState& last = session.drive.back();
  for (auto state = session.drive.rbegin(); state != session.drive.rend(); ++state)
    if (last.stamp - state->stamp >= std::chrono::milliseconds(100))
      return session.Metres(last.encoder_counts - state->encoder_counts) / Seconds(last.stamp - state->stamp);
  return HUGE_VAL;
}

TEST_P(HalConformance, StandsInTimeAfterACommandExpires) {
  Session session(GetParam());
  session.Drive(2.0, Go(0.8, 0.0, 0.05));
  const double speed_m_s = Speed_m_s(session);
  EXPECT_NEAR(speed_m_s, 0.8, 0.08);
  // Nothing sent any more: expiry after 50 ms, standing within 0.2 s + v / (2 m/s^2), and 0.1 s to see it.
  session.Drive(0.05 + 0.2 + speed_m_s / 2.0 + 0.1 + Seconds(session.rig->slack()), std::nullopt);
  EXPECT_LT(std::abs(Speed_m_s(session)), 0.01);
  EXPECT_TRUE(session.drive.back().expired);
}

TEST_P(HalConformance, BrakesAtOnceForANumberThatIsNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const bool in_speed : {true, false}) {
      Session session(GetParam());
      session.Drive(1.5, Go(0.8, 0.0, 1.0));
      session.robot.drive->Send(in_speed ? Go(bad, 0.0, 10.0) : Go(0.8, bad, 10.0));
      session.Drive(0.2 + 0.8 / 2.0 + 0.1 + Seconds(session.rig->slack()), std::nullopt);
      EXPECT_LT(std::abs(Speed_m_s(session)), 0.01);
    }
  }
}

// From expiry, for the motor and for the car to stand, and 0.1 s to see it.
double StandingTime_s(Session& session, double speed_m_s) {
  return 0.2 + std::abs(speed_m_s) / 2.0 + 0.1 + Seconds(session.rig->slack());
}

TEST_P(HalConformance, BrakesTheMotorWithin200MillisecondsOfExpiry) {
  Session session(GetParam());
  session.Drive(1.5, Go(0.8, 0.0, 1.0));
  session.robot.drive->Send(Go(0.8, 0.0, 0.1));
  const Time expiry = session.robot.clock->Now() + FromSeconds(0.1);
  session.Drive(0.6 + Seconds(session.rig->slack()), std::nullopt);
  for (const DriveState& state : session.drive) {
    if (state.stamp > expiry + FromSeconds(0.2) + session.rig->slack()) {
      EXPECT_TRUE(state.expired);
    }
  }
  EXPECT_TRUE(session.drive.back().expired);
}

// A command decided long ago, as after a stall of the stack, has expired when it comes.
TEST_P(HalConformance, StandsInTimeAfterACommandThatHasExpiredWhenItComes) {
  for (const Duration stale : {Duration(0), Duration::min()}) {
    Session session(GetParam());
    session.Drive(1.5, Go(0.8, 0.0, 1.0));
    session.robot.drive->Send({.speed_m_s = 0.8, .steering_rad = 0.0, .valid_for = stale});
    session.Drive(StandingTime_s(session, 0.8), std::nullopt);
    EXPECT_LT(std::abs(Speed_m_s(session)), 0.01) << stale.count();
    EXPECT_TRUE(session.drive.back().expired) << stale.count();
  }
}

TEST_P(HalConformance, ClampsCommandsBeyondTheCarsLimits) {
  Session session(GetParam());
  session.Drive(1.0, Go(0.0, 2.0));
  EXPECT_NEAR(session.drive.back().steering_rad, session.rig->car().steering_max_rad, 0.02);
}

TEST_P(HalConformance, DrivesNoFasterThanTheCarCanForHugeNumbersAndStopsAfterThem) {
  constexpr double kHuge = std::numeric_limits<double>::max();
  for (const double side : {1.0, -1.0}) {
    Session session(GetParam());
    // Held for ever, and replaced all the same.
    session.robot.drive->Send({.speed_m_s = side * kHuge, .steering_rad = 0.0, .valid_for = Duration::max()});
    session.Drive(1.5, std::nullopt);
    EXPECT_GT(side * Speed_m_s(session), 0.5 * session.rig->car().drivetrain.speed_max_m_s);
    EXPECT_LT(side * Speed_m_s(session), 1.1 * session.rig->car().drivetrain.speed_max_m_s);
    session.robot.drive->Send({.speed_m_s = 0.0, .steering_rad = -side * kHuge, .valid_for = FromSeconds(2.0)});
    session.Drive(1.9, std::nullopt);
    EXPECT_LT(std::abs(Speed_m_s(session)), 0.01);
    EXPECT_NEAR(session.drive.back().steering_rad, -side * session.rig->car().steering_max_rad, 0.02);
  }
}

// Thousands of commands between two polls of the devices, as from a stack out of control: the last one counts, no queue
// of old ones is processed before it, and it expires like any other.
TEST_P(HalConformance, TakesTheNewestOfAFloodAndItExpires) {
  Session session(GetParam());
  const auto flood = [&](const DriveCommand& newest) {
    for (int i = 0; i < 2000; ++i) session.robot.drive->Send(Go(i % 2 == 0 ? -0.8 : 0.8, 0.3, 10.0));
    session.robot.drive->Send(newest);
  };
  for (int i = 0; i < 50; ++i) {
    flood(Go(0.5, 0.0));
    session.Drive(0.02, std::nullopt);
  }
  flood(Go(0.5, 0.0, 0.5));
  session.Drive(0.4, std::nullopt);
  EXPECT_NEAR(Speed_m_s(session), 0.5, 0.08);
  EXPECT_NEAR(session.drive.back().steering_rad, 0.0, 0.02);
  session.Drive(0.1 + StandingTime_s(session, 0.5), std::nullopt);
  EXPECT_LT(std::abs(Speed_m_s(session)), 0.01);
  EXPECT_TRUE(session.drive.back().expired);
}

// The command in force would hold for long: the other end must brake by itself.
TEST_P(HalConformance, StandsInTimeWithItsPlugPulledAndDrivesAgainOncePluggedIn) {
  Session session(GetParam());
  session.Drive(1.5, Go(0.8, 0.0, 10.0));
  const double speed_m_s = Speed_m_s(session);
  const std::int64_t pulled = session.drive.back().encoder_counts;
  if (!session.rig->Unplug()) GTEST_SKIP() << "no plug to pull";
  session.Drive(StandingTime_s(session, speed_m_s), Go(0.8, 0.0, 10.0));
  EXPECT_EQ(session.robot.drive->Status().health, DeviceStatus::Health::kAbsent);
  session.robot.drive->Send({});
  session.rig->PlugIn();
  for (int i = 0; i < 200 && session.robot.drive->Status().health != DeviceStatus::Health::kOk; ++i)
    session.Drive(0.1, std::nullopt);
  session.drive.clear();
  session.Drive(0.3, std::nullopt);
  EXPECT_LT(std::abs(Speed_m_s(session)), 0.01);
  // What it may have gone: 0.2 s and the brakes, from a little after the last state.
  const double gone_m = session.Metres(session.drive.back().encoder_counts - pulled);
  EXPECT_LT(gone_m, speed_m_s * (0.2 + 0.1 + Seconds(session.rig->slack())) + speed_m_s * speed_m_s / 4.0);
  session.Drive(1.0, Go(0.5, 0.0));
  EXPECT_NEAR(Speed_m_s(session), 0.5, 0.08);
}

// The wall is square ahead: turned to the left, what is on the left is farther.
TEST_P(HalConformance, PansToTheLeftForPositiveAngles) {
  Session session(GetParam());
  if (session.robot.pan == nullptr) GTEST_SKIP() << "no pan unit";
  for (const double side : {1.0, -1.0}) {
    session.robot.pan->Send(side * 0.15);
    session.Drive(1.0, std::nullopt);
    EXPECT_NEAR(session.pan.back().angle_rad, side * 0.15, 0.01);
    const CameraModel& camera = session.robot.depth->Info().sheet.camera;
    const std::size_t row = static_cast<std::size_t>(camera.height / 2) * camera.width;
    const DepthFrame& frame = session.depth.back();
    EXPECT_GT(side * (frame.range_m[row + camera.width / 4] - frame.range_m[row + camera.width * 3 / 4]), 0.2) << side;
  }
}

TEST_P(HalConformance, PansAtItsSpeedToItsLimit) {
  Session session(GetParam());
  if (session.robot.pan == nullptr) GTEST_SKIP() << "no pan unit";
  session.Drive(0.5, std::nullopt);
  EXPECT_NEAR(session.pan.back().angle_rad, 0.0, 0.01) << "ahead at the start";
  const Time sent = session.robot.clock->Now();
  session.robot.pan->Send(3.0);
  session.Drive(1.5, std::nullopt);
  const CarPan pan = *session.rig->car().pan;
  const double limit_rad = session.rig->car().links[pan.link].joint_max_rad;
  for (const PanState& state : session.pan) {
    const double since_s = std::max(0.0, Seconds(state.stamp - sent));
    EXPECT_LE(state.angle_rad, pan.slew_rad_s * since_s + 0.05);
    EXPECT_GE(state.angle_rad,
              std::min(limit_rad, pan.slew_rad_s * (since_s - 0.1 - Seconds(session.rig->slack()))) - 0.05);
  }
  EXPECT_NEAR(session.pan.back().angle_rad, limit_rad, 0.02);
}

TEST_P(HalConformance, HoldsItsPanAngleWhenNothingMoreIsSentAndIgnoresWhatIsNoNumber) {
  Session session(GetParam());
  if (session.robot.pan == nullptr) GTEST_SKIP() << "no pan unit";
  session.robot.pan->Send(-0.8);
  session.Drive(1.0, Go(0.0, 0.0, 0.05));
  session.robot.pan->Send(std::nan(""));
  session.robot.pan->Send(HUGE_VAL);
  session.Drive(2.0, std::nullopt);
  EXPECT_TRUE(session.drive.back().expired);
  for (const PanState& state : session.pan)
    EXPECT_TRUE(session.pan.back().stamp - state.stamp >= std::chrono::seconds(2) ||
                std::abs(state.angle_rad + 0.8) < 0.02);
  for (std::size_t i = 1; i < session.pan.size(); ++i) EXPECT_GT(session.pan[i].stamp, session.pan[i - 1].stamp);
  EXPECT_EQ(session.robot.pan->Status().health, DeviceStatus::Health::kOk);
}

TEST_P(HalConformance, ReturnsAtOnceForATimeThatHasPassed) {
  Session session(GetParam());
  const Time before = session.robot.clock->Now();
  EXPECT_TRUE(session.robot.clock->WaitUntil(before));
  EXPECT_TRUE(session.robot.clock->WaitUntil(before - kTick));
  EXPECT_GE(session.robot.clock->Now(), before);
}

}  // namespace
}  // namespace merlin
