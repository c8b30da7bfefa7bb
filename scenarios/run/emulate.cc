#include "scenarios/run/emulate.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <utility>

#include "robot/base/error.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/judge/output_path.h"
#include "scenarios/judge/writers.h"
#include "scenarios/run/emulation.h"
#include "scenarios/run/ground_truth.h"

namespace merlin {

const char kEmulatedHardwareFile[] = "# merlin emulate wrote this file, and removes it when it ends.";

namespace {

namespace fs = std::filesystem;

constexpr Duration kTick = std::chrono::milliseconds(50);
constexpr Duration kAnswer = std::chrono::seconds(10);  // time for each device to answer
constexpr double kAtRest_m_s = 0.01;

std::string FirstLine(const fs::path& file) {
  std::string line;
  std::getline(std::ifstream(file), line);
  return line;
}

// The hardware file, which exists as long as this object. Replaces one left by an earlier emulator.
class PublishedFile {
 public:
  explicit PublishedFile(fs::path file) : file_(std::move(file)) {
    CheckOutputFile(file_, "--hardware-file");
    std::error_code error;
    if (!fs::exists(file_, error)) return;
    if (FirstLine(file_) != kEmulatedHardwareFile)
      throw InputError("--hardware-file " + file_.string(), "already exists and was not written by merlin emulate",
                       "a new file, or one that merlin emulate left");
    fs::remove(file_, error);  // so that a program that waits for the file waits for the new one
  }
  ~PublishedFile() {
    std::error_code ignored;
    if (!text_.empty() && fs::exists(file_, ignored) && ReadText(file_) == text_) fs::remove(file_, ignored);
  }
  PublishedFile(const PublishedFile&) = delete;
  PublishedFile& operator=(const PublishedFile&) = delete;

  void Publish(const HardwareConfig& devices) {
    text_ = std::string(kEmulatedHardwareFile) + "\n" + ToYaml(devices);
    WriteFile(file_, text_);
  }

 private:
  static std::string ReadText(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path file_;
  std::string text_;  // empty: not published yet
};

// Checks with a driver of our own that every device answers.
void RequireAnswers(const HardwareConfig& devices, const HardwareCameras& cameras) {
  std::string complaints;
  for (const DeviceReport& report : CheckDevices(devices, cameras, kAnswer))
    if (!report.works()) complaints += (complaints.empty() ? "" : "\n") + report.complaint;
  if (!complaints.empty()) throw MachineError(complaints);
}

// Waits until the driver of RequireAnswers has disconnected.
void WaitForLeave(EmulatedRobot& robot, RealClock& clock) {
  while (robot.HasDriver()) clock.WaitUntil(clock.Now() + std::chrono::milliseconds(5));
}

// True state of the car.
struct CarNow {
  Time time;
  double speed_m_s;
  Pose T_world_base;
};

// Reports changes between two ticks as sentences.
class Watch {
 public:
  Watch(Emulation& emulation, const std::function<void(const std::string&)>& say) : emulation_(emulation), say_(say) {}

  void Look(const CarNow& car) {
    const bool was_driven = std::exchange(driven_, emulation_.robot().HasDriver());
    if (driven_) stood_ = false;
    if (driven_ && !was_driven) Say(car.time, "a program drives the car");
    if (!driven_ && was_driven) {
      emulation_.robot().FreePorts();
      Say(car.time, "the driving program has gone; the car brakes");
    }
    if (driven_ || stood_ || std::abs(car.speed_m_s) >= kAtRest_m_s) return;
    stood_ = true;
    Say(car.time, fmt::format("the car stands at x {:.2f} m, y {:.2f} m, and waits for the next program",
                              car.T_world_base.translation().x(), car.T_world_base.translation().y()));
  }

 private:
  void Say(Time now, const std::string& sentence) { say_(fmt::format("{:8.1f} s: {}", Seconds(now), sentence)); }

  Emulation& emulation_;
  const std::function<void(const std::string&)>& say_;
  bool driven_ = false, stood_ = true;
};

std::string Serving(const HardwareConfig& devices, const fs::path& file) {
  std::string text = "serving drive " + devices.drive.serial.port;
  if (devices.compass) text += ", compass " + devices.compass->serial.port;
  text += ", depth camera " + devices.depth.pmd.source_argument;
  if (devices.color) text += ", colour camera " + devices.color->source;
  return text + "; drive them with --robot hardware:" + file.string();
}

}  // namespace

EmulateReport Emulate(const EmulateOptions& options, const std::atomic<bool>& stop) {
  PublishedFile file(options.hardware_file);
  RealClock clock({}, Time::max());
  Emulation emulation(options.run, clock);
  const HardwareConfig devices = emulation.Devices();
  RequireAnswers(devices, emulation.cameras());
  WaitForLeave(emulation.robot(), clock);
  file.Publish(devices);
  options.say(Serving(devices, options.hardware_file));
  Watch watch(emulation, options.say);
  EmulateReport report;
  for (Time tick = clock.Now(); !stop.load() && report.car_lost.empty(); tick += kTick) {
    clock.WaitUntil(tick);
    watch.Look(emulation.WithTruth([&](Truth& truth, const sim::World& world) {
      truth.Keep(world.Now());
      report.car_lost = truth.car_lost();
      return CarNow{world.Now(), world.Speed_m_s(), world.T_world_base()};
    }));
  }
  emulation.robot().Stop();
  const GroundTruth truth = emulation.WithTruth(GroundTruthOf);
  report.truth = truth.path;
  report.collisions = truth.collisions;
  for (const std::string& note : emulation.Notes()) options.say("note: " + note);
  return report;
}

}  // namespace merlin
