#include "tools/calibrate/test_drive.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "robot/base/random.h"
#include "robot/description/description.h"
#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/motion.h"
#include "scenarios/config/names.h"

namespace merlin {
namespace {

constexpr double kSpeed_m_s = 0.4;
constexpr double kSide_m = 2.0, kCorner_rad = 0.35;  // of the square
constexpr double kCircle_rad = 0.2;
constexpr std::uint16_t kTapeNoise = 1;  // key of the tape's random numbers; the encoder uses 0

// The simulated car on its floor, with the controls that a test drive needs.
class TestDrive {
 public:
  explicit TestDrive(const sim::WorldOptions& twin) : world_(twin) { Wait(0.5); }

  void Send(double speed_m_s, double steering_rad) {
    world_.drive().Send({.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = std::chrono::hours(1)},
                        world_.Now());
  }
  void Wait(double seconds) {
    for (const Time end = world_.Now() + FromSeconds(seconds); world_.Now() < end;) Step();
  }
  void Step() {
    world_.Step();
    if (on_state && world_.Now() >= next_state_) {
      next_state_ = world_.Now() + std::chrono::milliseconds(20);
      on_state(State());
    }
  }
  void Stand() {
    Send(0.0, 0.0);
    Wait(1.5);
  }
  DriveState State() const { return world_.drive().Read(world_.model(), world_.data(), world_.Now()); }
  Pose T_world_base() const { return world_.T_world_base(); }

  std::function<void(const DriveState&)> on_state;  // 50 times a second

 private:
  sim::World world_;
  Time next_state_{0};
};

StraightDrive DriveStraight(const sim::WorldOptions& twin, double way_m) {
  TestDrive drive(twin);
  // The car drives up to the first mark, so that the backlash of the gear is on the same side at both marks.
  drive.Send(kSpeed_m_s, 0.0);
  drive.Wait(1.0);
  drive.Stand();
  const Eigen::Vector3d start = drive.T_world_base().translation();
  const std::int64_t counts = drive.State().encoder_counts;
  drive.Send(kSpeed_m_s, 0.0);
  while (Path_m(twin.car, drive.State().encoder_counts - counts, 0.0) < way_m) drive.Step();
  drive.Stand();
  return {drive.State().encoder_counts - counts, (drive.T_world_base().translation() - start).norm()};
}

// first_rad: the steering angle from which the servo turns to steering_rad.
CircleDrive DriveCircle(const sim::WorldOptions& twin, double first_rad, double steering_rad) {
  TestDrive drive(twin);
  drive.Send(0.0, first_rad);
  drive.Wait(0.5);
  drive.Send(0.0, steering_rad);
  drive.Wait(0.5);
  drive.Send(kSpeed_m_s, steering_rad);
  drive.Wait(1.0);
  const Pose start = drive.T_world_base();
  double reported_rad = 0.0, turned_rad = 0.0;
  int steps = 0;
  for (Pose before = start; std::abs(turned_rad) < std::numbers::pi; ++steps) {
    drive.Step();
    reported_rad += drive.State().steering_rad;
    turned_rad += WrapPi(Yaw(drive.T_world_base()) - Yaw(before));
    before = drive.T_world_base();
  }
  return {reported_rad / steps, (drive.T_world_base().translation() - start.translation()).norm()};
}

// Follows one manoeuvre with both odometries, from the same start as the car.
class Comparison {
 public:
  Comparison(const sim::WorldOptions& twin, const CarCalibration& calibration)
      : calibrated_(Calibrated(twin.car, calibration)),
        drive_(twin),
        before_(twin.car),
        after_(calibrated_),
        T_world_start_(drive_.T_world_base()) {
    drive_.on_state = [this](const DriveState& state) { Watch(state); };
    Watch(drive_.State());
  }

  void DriveTurn(double steering_rad, double turn_rad) {
    const double start_rad = turned_rad_;
    drive_.Send(kSpeed_m_s, ServoAngle_rad(calibrated_, steering_rad));
    while (std::abs(turned_rad_ - start_rad) < turn_rad) drive_.Step();
  }
  void DriveStraight(double way_m) {
    const double start_m = path_m_;
    drive_.Send(kSpeed_m_s, ServoAngle_rad(calibrated_, 0.0));
    while (path_m_ - start_m < way_m) drive_.Step();
  }
  Manoeuvre End(const std::string& name) {
    drive_.Stand();
    const Pose T_start_end = T_world_start_.inverse() * drive_.T_world_base();
    const auto error_m = [&](const Odometry& odometry) {
      return (odometry.At(last_)->translation() - T_start_end.translation()).head<2>().norm();
    };
    return {name, path_m_, error_m(before_), error_m(after_)};
  }

 private:
  void Watch(const DriveState& state) {
    const Pose T_odom_base = after_.At(last_).value_or(Pose::Identity());
    before_.Update(state);
    after_.Update(state);
    last_ = state.stamp;
    const Pose T_motion = T_odom_base.inverse() * *after_.At(last_);
    path_m_ += T_motion.translation().norm();
    turned_rad_ += Yaw(T_motion);
  }

  CarDescription calibrated_;
  TestDrive drive_;
  Odometry before_, after_;
  Pose T_world_start_;
  Time last_{0};
  double path_m_ = 0.0, turned_rad_ = 0.0;
};

}  // namespace

MeasuredDrives DriveAndMeasure(const sim::WorldOptions& twin) {
  MeasuredDrives drives;
  auto tape = [&drives, seed = twin.seed, index = std::uint64_t{0}](double true_m) mutable {
    return true_m + drives.tape_sigma_m * Random(seed, Sensor::kDrive, index++, 0, kTapeNoise).Normal();
  };
  for (const double way_m : {4.0, 6.0}) drives.straights.push_back(DriveStraight(twin, way_m));
  for (const double side : {1.0, -1.0})
    for (const double steering_rad : {0.2, 0.35})
      for (const double first : {0.8, 1.2})
        drives.circles.push_back(DriveCircle(twin, side * first * steering_rad, side * steering_rad));
  for (StraightDrive& drive : drives.straights) drive.distance_m = tape(drive.distance_m);
  for (CircleDrive& drive : drives.circles) drive.diameter_m = tape(drive.diameter_m);
  return drives;
}

std::vector<Manoeuvre> DriveManoeuvres(const sim::WorldOptions& twin, const CarCalibration& calibration) {
  std::vector<Manoeuvre> manoeuvres;
  for (const double side : {1.0, -1.0}) {
    const std::string where = side > 0.0 ? " to the left" : " to the right";
    Comparison circle(twin, calibration);
    circle.DriveTurn(side * kCircle_rad, 2.0 * std::numbers::pi);
    manoeuvres.push_back(circle.End("circle" + where));
    Comparison square(twin, calibration);
    for (int corner = 0; corner < 4; ++corner) {
      square.DriveStraight(kSide_m);
      square.DriveTurn(side * kCorner_rad, 0.5 * std::numbers::pi);
    }
    manoeuvres.push_back(square.End("square" + where));
  }
  return manoeuvres;
}

sim::WorldOptions OnOpenFloor(const Scenario& scenario) {
  return {.room = RoomFile("open_floor"),
          .car = ReadCar(CarFile(scenario.car.model)),
          .drivetrain = scenario.car.drivetrain,
          .materials = sim::ReadMaterials(Home() / "models/materials.yaml"),
          .seed = scenario.seed};
}

}  // namespace merlin
