#include "scenarios/run/emulation.h"

#include <fmt/format.h>

#include <cstdlib>

#include "robot/base/error.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/run/hardware_plug.h"
#include "scenarios/run/twin_options.h"

namespace merlin {
namespace {

std::string PmdLibrary() {
  const char* other = std::getenv("MERLIN_PMD_LIBRARY");
  return other != nullptr ? other : MERLIN_PMD_LIBRARY;
}

}  // namespace

SocketFolder::SocketFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "merlin-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw MachineError(name + ": cannot make a folder for the devices' sockets");
  path_ = name;
}

SocketFolder::~SocketFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Emulation::Emulation(const RunOptions& options, const Clock& clock) {
  const Scenario& scenario = options.scenario;
  RequireNoTurntable(scenario);
  cameras_ = CamerasOf(scenario);
  std::string without_color;
  MakeWithColor(TwinOptionsOf(scenario, options), scenario, without_color, [&](const TwinOptions& with) {
    robot_ = std::make_unique<EmulatedRobot>(with, sockets_.path(), clock);
    car_ = with.world.car.name;
    if (!with.color) cameras_.color.reset();
  });
  robot_->With([&](Twin& twin) {
    RequirePlan(scenario, twin.world());
    truth_.emplace(scenario, twin.world());
    twin.OnStep([this](auto& world) { truth_->Watch(world); });
    renderer_ = twin.gl_name();
    notes_ = NotesOf(without_color, twin.world());
  });
  robot_->Start();
}

HardwareConfig Emulation::Devices() const {
  HardwareConfig config;
  config.car = car_;
  config.drive.serial = {robot_->drive_port(), EmulatedRobot::kDriveBaud};
  if (const auto port = robot_->compass_port()) config.compass.emplace().serial = {*port, 9600};
  config.depth.pmd.library = PmdLibrary();
  config.depth.pmd.source_argument = robot_->depth_socket();
  if (const auto url = robot_->color_url()) {
    config.color.emplace().source = *url;
    config.color->stream_latency_s = EmulatedRobot::kStreamLatency_s;
  }
  return config;
}

std::vector<std::string> Emulation::Notes() const {
  std::vector<std::string> notes = notes_;
  if (robot_->lag() > std::chrono::milliseconds(100))
    notes.push_back(fmt::format("the world fell {:.0f} ms behind the clock: this machine was too slow at times",
                                1e3 * Seconds(robot_->lag())));
  return notes;
}

}  // namespace merlin
