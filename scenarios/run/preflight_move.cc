#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "perception/odometry.h"
#include "robot/base/error.h"
#include "scenarios/run/hear.h"
#include "scenarios/run/preflight.h"

namespace merlin {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr Duration kTick = std::chrono::milliseconds(20);
constexpr Duration kValid = std::chrono::milliseconds(300);
constexpr Duration kSettle = std::chrono::seconds(1);
constexpr double kSpeed_m_s = 0.1;
constexpr double kStands_m_s = 0.01;

constexpr double kStraight_m = 0.05, kStraightTolerance_m = 0.025;
constexpr double kStop_m = 0.15;
// Time to stop after the last command: the motor brakes within 0.2 s, then the car slows down at 2 m/s2
// (robot/hal/drive.h). The rest allows for the latency of states.
constexpr double kStopTime_s = 0.2 + kSpeed_m_s / 2.0 + 0.2;
constexpr double kArc_m = 0.3, kArcSteering_rad = 0.3, kSteeringTolerance_rad = 0.05;
constexpr double kTurnShare = 0.3, kTurnTolerance_rad = 3.0 / kDegrees;

struct Interrupted {};

// Drives a car and tracks it by its wheels and its compass. Every call throws DeviceError if a device fails, and
// Interrupted once stop is set.
class Trial {
 public:
  Trial(const Robot& robot, const CarDescription& car, const std::atomic<bool>& stop)
      : robot_(robot), stop_(stop), ears_(robot), odometry_(car) {}

  // Drives this distance ahead (negative: back). Gives up after twice the expected time plus half a second, because
  // with a broken encoder the car would never stop.
  void Go(double distance_m, double steering_rad) {
    const Pose T_odom_from = T_odom_base();
    const double speed_m_s = std::copysign(kSpeed_m_s, distance_m);
    const Time end = robot_.clock->Now() + FromSeconds(2.0 * distance_m / speed_m_s + 0.5);
    while (robot_.clock->Now() < end && std::abs(PathSince(T_odom_from)) < std::abs(distance_m))
      Tick(DriveCommand{speed_m_s, steering_rad, kValid});
  }
  // Commands speed 0 with this steering angle, long enough for the car to stop.
  void Halt(double steering_rad = 0.0) {
    for (const Time end = robot_.clock->Now() + kSettle; robot_.clock->Now() < end;)
      Tick(DriveCommand{0.0, steering_rad, kValid});
  }
  // Sends nothing.
  void Wait(double seconds) {
    for (const Time end = robot_.clock->Now() + FromSeconds(seconds); robot_.clock->Now() < end;) Tick(std::nullopt);
  }

  Pose T_odom_base() {
    while (!last_) Tick(std::nullopt);
    return *odometry_.At(last_->stamp);
  }
  // Distance along the path, positive ahead.
  double PathSince(const Pose& T_odom_from) {
    const Eigen::Vector3d gone =
        T_odom_from.linear().transpose() * (T_odom_base().translation() - T_odom_from.translation());
    return std::copysign(gone.norm(), gone.x());
  }
  double TurnSince(const Pose& T_odom_from) { return WrapPi(Yaw(T_odom_base()) - Yaw(T_odom_from)); }
  // Mean speed over the last 0.1 s, so that a single count between two states does not look like a speed.
  double speed_m_s() { return PathSince(*odometry_.At(last_->stamp - std::chrono::milliseconds(100))) / 0.1; }
  double steering_rad() const { return last_ ? last_->steering_rad : 0.0; }
  // Mean compass yaw while the car stands; none if no reading came.
  std::optional<double> CompassYaw_rad() {
    compass_.clear();
    Halt(steering_rad());
    Eigen::Vector2d sum(0.0, 0.0);
    for (const double yaw_rad : compass_) sum += Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
    if (compass_.empty()) return std::nullopt;
    return std::atan2(sum.y(), sum.x());
  }
  bool has_compass() const { return robot_.compass != nullptr; }

 private:
  void Tick(const std::optional<DriveCommand>& command) {
    if (stop_.load()) throw Interrupted();
    if (command) UseDevice("drive", [&] { robot_.drive->Send(*command); });
    if (!robot_.clock->WaitUntil(robot_.clock->Now() + kTick)) throw DeviceError("the clock has ended");
    LoopState::Heard heard;
    ears_.Hear(heard);
    for (const CompassReading& reading : heard.compass) compass_.push_back(reading.yaw_rad);
    for (const DriveState& state : heard.drive) {
      if (!std::isfinite(state.steering_rad))
        throw DeviceError("the drive reports a steering angle that is not a number");
      odometry_.Update(state);
      last_ = state;
    }
    const SupervisedDevice& drive = ears_.Of("drive");
    if (HealthOf(drive, robot_.clock->Now()) != DeviceStatus::Health::kOk) throw DeviceError("the drive fell silent");
  }

  Robot robot_;
  const std::atomic<bool>& stop_;
  Ears ears_;
  Odometry odometry_;
  std::optional<DriveState> last_;
  std::vector<double> compass_;  // yaws
};

// Checks that the wheels follow the command.
std::string StraightFault(Trial& trial) {
  for (const double distance_m : {kStraight_m, -kStraight_m}) {
    const Pose T_odom_from = trial.T_odom_base();
    trial.Go(distance_m, 0.0);
    trial.Halt();
    const double gone_m = trial.PathSince(T_odom_from);
    if (std::abs(gone_m - distance_m) > kStraightTolerance_m)
      return fmt::format("told to drive {:+.0f} cm, the wheels turned by {:+.1f} cm", 1e2 * distance_m, 1e2 * gone_m);
  }
  return "";
}

// Checks that the car stops after the last command.
std::string StopFault(Trial& trial) {
  const Pose T_odom_from = trial.T_odom_base();
  trial.Go(kStop_m, 0.0);
  trial.Wait(Seconds(kValid) + kStopTime_s);
  const double speed_m_s = trial.speed_m_s();
  trial.Halt();
  trial.Go(-trial.PathSince(T_odom_from), 0.0);
  trial.Halt();
  if (std::abs(speed_m_s) < kStands_m_s) return "";
  return fmt::format("the car still drove {:.2f} m/s, {:.1f} s after the last command had ended", speed_m_s,
                     kStopTime_s);
}

// Checks that compass and wheels agree about the turn on an arc to this side.
std::string TurnFault(Trial& trial, double side) {
  const double steering_rad = side * kArcSteering_rad;
  trial.Halt(steering_rad);
  if (std::abs(trial.steering_rad() - steering_rad) > kSteeringTolerance_rad)
    return fmt::format("told to steer {:+.0f} deg, the servo reports {:+.1f} deg", kDegrees * steering_rad,
                       kDegrees * trial.steering_rad());
  const Pose T_odom_from = trial.T_odom_base();
  const auto before_rad = trial.CompassYaw_rad();
  trial.Go(kArc_m, steering_rad);
  const auto after_rad = trial.CompassYaw_rad();
  const double wheels_rad = trial.TurnSince(T_odom_from);
  trial.Go(-trial.PathSince(T_odom_from), steering_rad);
  trial.Halt();
  if (!trial.has_compass()) return "";
  if (!before_rad || !after_rad) return "the compass fell silent";
  const double compass_rad = WrapPi(*after_rad - *before_rad);
  if (std::abs(compass_rad - wheels_rad) <= kTurnShare * std::abs(wheels_rad) + kTurnTolerance_rad) return "";
  return fmt::format("on an arc to the {} the wheels turned the car by {:+.0f} deg, the compass by {:+.0f} deg",
                     side > 0.0 ? "left" : "right", kDegrees * wheels_rad, kDegrees * compass_rad);
}

// Runs the checks in order and returns the faults of the first that fails.
std::vector<std::string> Try(Trial& trial) {
  if (std::string fault = StraightFault(trial); !fault.empty()) return {std::move(fault)};
  if (std::string fault = StopFault(trial); !fault.empty()) return {std::move(fault)};
  std::vector<std::string> faults{TurnFault(trial, 1.0), TurnFault(trial, -1.0)};
  std::erase(faults, "");
  return faults;
}

}  // namespace

std::vector<std::string> PreflightMoving(const Robot& robot, const CarDescription& car, const std::atomic<bool>& stop) {
  std::vector<std::string> faults;
  try {
    Trial trial(robot, car, stop);
    faults = Try(trial);
  } catch (const DeviceError& error) {
    faults.push_back(error.what());
  } catch (const Interrupted&) {
  }
  try {
    // In every case: this command expires at once, so the car brakes.
    UseDevice("drive", [&] { robot.drive->Send({}); });
  } catch (const DeviceError& error) {
    faults.push_back(error.what());
  }
  return faults;
}

}  // namespace merlin
