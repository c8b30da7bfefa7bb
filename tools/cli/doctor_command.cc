// `merlin doctor`.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "scenarios/config/believed_car.h"
#include "scenarios/config/hardware_check.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/run/preflight.h"
#include "tools/cli/commands.h"
#include "tools/cli/doctor.h"
#include "tools/json_text.h"

namespace merlin::cli {
namespace {

constexpr Duration kListen = std::chrono::seconds(3);  // to each device

struct RobotArguments {
  std::string robot, scenario = "corridor_loop";
  bool move = false, json = false;
};

// The result of the check of a car.
struct RobotReport {
  std::vector<DeviceReport> devices;
  std::vector<std::string> preflight;  // faults; empty as well if a device fails, since nothing was checked

  bool devices_work() const { return std::ranges::all_of(devices, &DeviceReport::works); }
  bool well() const { return devices_work() && preflight.empty(); }
};

// All devices together, in the way a run uses them.
std::vector<std::string> Preflight(const HardwareConfig& config, const Scenario& scenario, bool move) {
  RealClock clock(config.clock, Time::max());
  HardwareRobot hardware(config, CamerasOf(scenario), clock);
  std::vector<std::string> faults = hardware.WaitUntilReady(kListen);
  if (!faults.empty()) return faults;
  const CarDescription car = BelievedCar(scenario.car);
  faults = PreflightAtRest(hardware.robot(), car);
  if (faults.empty() && move) faults = PreflightMoving(hardware.robot(), car, interrupted);
  return faults;
}

void PrintJson(const std::string& robot, const RobotReport& report) {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const DeviceReport& device : report.devices)
    devices.push_back({{"device", device.device}, {"works", device.works()}, {"detail", device.complaint}});
  fmt::print("{}",
             JsonText({{"well", report.well()},
                       {"robot", robot},
                       {"devices", devices},
                       {"preflight", report.devices_work() ? nlohmann::ordered_json(report.preflight) : nullptr}}));
}

void PrintText(const RobotReport& report, bool move) {
  for (const DeviceReport& device : report.devices)
    fmt::print("{}\n", device.works() ? device.device + ": works" : device.complaint);
  for (const std::string& fault : report.preflight) fmt::print("{}\n", fault);
  if (report.well())
    fmt::print("The car is fit to drive{}.\n", move ? "" : ", as far as can be told at rest (--move: and moving)");
}

// The exit code of a run with these devices. A run opens them in this order, and stops at the first that does not open.
int ExitCodeOf(const RobotReport& report) {
  using enum DeviceReport::Fault;
  for (const DeviceReport& device : report.devices)
    if (device.fault == kBadConfig || device.fault == kNotOpened)
      return device.fault == kBadConfig ? kBadInput : kCannot;
  return report.well() ? kPass : kCannot;
}

// Tests the devices of a real car, first each by itself, then all together.
int CheckRobot(const RobotArguments& arguments) {
  const std::string hardware = "hardware:", &robot = arguments.robot;
  if (!robot.starts_with(hardware) || robot.size() == hardware.size())
    throw InputError("--robot", "no devices to check", "hardware:FILE, which names them", "'" + robot + "'");
  const HardwareConfig config = ReadHardwareFile(robot.substr(hardware.size()));
  const Scenario scenario = ReadScenario(arguments.scenario, {});
  RequireFits(config, scenario, robot.substr(hardware.size()));
  RobotReport report{CheckDevices(config, CamerasOf(scenario), kListen), {}};
  if (report.devices_work()) report.preflight = Preflight(config, scenario, arguments.move);
  if (interrupted) return kInterrupted;
  if (arguments.json)
    PrintJson(robot, report);
  else
    PrintText(report, arguments.move);
  return ExitCodeOf(report);
}

}  // namespace

void AddDoctor(CLI::App& app, int& exit_code) {
  struct Flags {
    bool licenses = false;
    RobotArguments robot;
  };
  const auto flags = std::make_shared<Flags>();
  CLI::App* doctor = app.add_subcommand("doctor", "what works here: GL back ends, devices, versions, licences");
  CLI::Option* licenses = doctor->add_flag("--licenses", flags->licenses, "everything linked, and its terms");
  CLI::Option* robot = doctor->add_option(
      "--robot", flags->robot.robot,
      "hardware:FILE: check that the devices that FILE names deliver at their rates, and plausible values; moves "
      "nothing. Exit 3: one does not");
  robot->check(NotEmpty)->excludes(licenses);
  doctor->add_option("--scenario", flags->robot.scenario, "whose car and cameras these are; default corridor_loop")
      ->needs(robot);
  doctor
      ->add_flag("--move", flags->robot.move,
                 "then drive 30 cm to and fro, to check wheels, stopping and compass; needs half a metre of free floor "
                 "ahead and at both sides")
      ->needs(robot);
  doctor->add_flag("--json", flags->robot.json, "for machines");
  doctor->callback([flags, &exit_code] {
    exit_code = flags->robot.robot.empty() ? Doctor(flags->licenses, flags->robot.json) : CheckRobot(flags->robot);
  });
}

}  // namespace merlin::cli
