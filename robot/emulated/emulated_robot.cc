#include "robot/emulated/emulated_robot.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "robot/emulated/serial_line.h"

namespace merlin {
namespace {

constexpr double kLowBattery = 0.9;  // of the nominal voltage (guess): below it the battery is soon empty
constexpr auto kNap = std::chrono::microseconds(500);
// Setting up takes time, and the world begins late. From when it is less late than this, its lag is measured.
constexpr Duration kCaughtUp = std::chrono::milliseconds(20);

EmulatedCar CarOf(Twin& twin) {
  EmulatedCar car{.send = [&twin](const DriveCommand& command) { twin.robot().drive->Send(command); },
                  .read =
                      [&twin] {
                        const sim::World& world = std::as_const(twin).world();
                        return world.drive().Read(world.model(), world.data(), world.Now());
                      }};
  if (twin.robot().pan == nullptr) return car;
  car.pan = [&twin](double angle_rad) { twin.robot().pan->Send(angle_rad); };
  car.pan_angle_rad = [&twin] {
    const sim::World& world = std::as_const(twin).world();
    return world.pan()->Read_rad(world.data());
  };
  return car;
}

// The options of the twin behind the devices. It has no end, and computes attitudes at a high rate, because a device
// may be asked at any time.
TwinOptions ForDevices(TwinOptions options) {
  options.end = Time::max();
  if (options.compass) options.compass->rate_hz = 250.0;
  return options;
}

}  // namespace

EmulatedRobot::EmulatedRobot(const TwinOptions& options, const std::filesystem::path& sockets, const Clock& clock)
    : clock_(clock),
      twin_(ForDevices(options)),
      robot_(twin_.robot()),
      drive_({.battery_low_v = kLowBattery * options.world.car.drivetrain.voltage_max_v}, CarOf(twin_), Time(0)),
      drive_pump_(drive_terminal_, std::make_unique<SerialLine>(kDriveBaud), drive_, kDriveBaud),
      depth_socket_((sockets / "depth.socket").string()),
      depth_(depth_socket_, options.depth.sheet, options.depth.settings, [this](const DepthSettings& settings) {
        const std::lock_guard lock(mutex_);
        robot_.depth->Configure(settings);
      }) {
  if (robot_.compass != nullptr) {
    compass_terminal_.emplace();
    compass_.emplace(Compass3dmEmulatorConfig{.north_yaw_rad = std::as_const(twin_).world().north_yaw_rad()},
                     [this] { return Attitude(); });
    compass_pump_.emplace(*compass_terminal_, std::make_unique<SerialLine>(9600), *compass_, 9600);
  }
  if (robot_.color != nullptr) color_.emplace();
}

EmulatedRobot::~EmulatedRobot() { Stop(); }

std::optional<std::string> EmulatedRobot::compass_port() const {
  if (!compass_terminal_) return std::nullopt;
  return compass_terminal_->path().string();
}

std::optional<std::string> EmulatedRobot::color_url() const {
  if (!color_) return std::nullopt;
  return color_->url();
}

void EmulatedRobot::FreePorts() {
  drive_terminal_.Unclaim();
  if (compass_terminal_) compass_terminal_->Unclaim();
}

void EmulatedRobot::Start() {
  if (!thread_.joinable()) thread_ = std::thread([this] { Run(); });
}

void EmulatedRobot::Stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void EmulatedRobot::Run() {
  try {
    while (!stop_) {
      StepTo(clock_.Now());
      std::this_thread::sleep_for(kNap);
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
}

// Makes single steps and releases the lock between them, so that nobody waits long for it.
void EmulatedRobot::StepTo(Time now) {
  while (!stop_) {
    const std::lock_guard lock(mutex_);
    const Time world = robot_.clock->Now();
    caught_up_ = caught_up_ || now - world < kCaughtUp;
    if (caught_up_) lag_ = std::max<std::int64_t>(lag_, (now - world).count());
    if (world + sim::World::kStep > now) return;
    robot_.clock->WaitUntil(world + sim::World::kStep);
    ServeDevices();
  }
}

void EmulatedRobot::ServeDevices() {
  while (robot_.compass != nullptr) {
    const auto reading = robot_.compass->Poll();
    if (!reading) break;
    attitude_ = reading;
  }
  while (auto frame = robot_.depth->Poll()) depth_.Publish(*frame);
  while (color_) {
    auto frame = robot_.color->Poll();
    if (!frame) break;
    color_->Publish(std::move(*frame));
  }
  // The devices' own clocks do not stop when this machine is too slow for the world.
  const Time now = clock_.Now();
  drive_pump_.Step(now);
  if (compass_pump_) compass_pump_->Step(now);
}

// The last reading of the simulated sensor.
CompassReading EmulatedRobot::Attitude() { return attitude_.value_or(CompassReading{}); }

}  // namespace merlin
