// `merlin doctor`.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "scenarios/config/hardware_check.h"
#include "scenarios/config/hardware_file.h"
#include "tools/cli/commands.h"
#include "tools/cli/doctor.h"
#include "tools/json_text.h"

namespace merlin::cli {
namespace {

constexpr Duration kListen = std::chrono::seconds(3);  // to each device

void PrintJson(const std::string& robot, const std::vector<DeviceReport>& reports) {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  bool well = true;
  for (const DeviceReport& report : reports) {
    devices.push_back({{"device", report.device}, {"works", report.works()}, {"detail", report.complaint}});
    well &= report.works();
  }
  fmt::print("{}", JsonText({{"well", well}, {"robot", robot}, {"devices", devices}}));
}

// Of a run with these devices: it opens them in this order, and stops at the first that cannot be opened.
int ExitCodeOf(const std::vector<DeviceReport>& reports) {
  using enum DeviceReport::Fault;
  for (const DeviceReport& report : reports)
    if (report.fault == kBadConfig || report.fault == kNotOpened)
      return report.fault == kBadConfig ? kBadInput : kCannot;
  return std::ranges::all_of(reports, &DeviceReport::works) ? kPass : kCannot;
}

// The devices of a real car, each by itself.
int CheckRobot(const std::string& robot, const std::string& scenario, bool json) {
  const std::string hardware = "hardware:";
  if (!robot.starts_with(hardware) || robot.size() == hardware.size())
    throw InputError("--robot", "no devices to check", "hardware:FILE, which names them", "'" + robot + "'");
  const HardwareConfig config = ReadHardwareFile(robot.substr(hardware.size()));
  const Scenario drives = ReadScenario(scenario, {});
  RequireFits(config, drives, robot.substr(hardware.size()));
  const auto reports = CheckDevices(config, CamerasOf(drives), kListen);
  if (json) PrintJson(robot, reports);
  for (const DeviceReport& report : reports)
    if (!json) fmt::print("{}\n", report.works() ? report.device + ": works" : report.complaint);
  return ExitCodeOf(reports);
}

}  // namespace

void AddDoctor(CLI::App& app, int& exit_code) {
  struct Flags {
    bool licenses = false, json = false;
    std::string robot, scenario = "corridor_loop";
  };
  const auto flags = std::make_shared<Flags>();
  CLI::App* doctor = app.add_subcommand("doctor", "what works here: GL back ends, devices, versions, licences");
  CLI::Option* licenses = doctor->add_flag("--licenses", flags->licenses, "everything linked, and its terms");
  CLI::Option* robot =
      doctor->add_option("--robot", flags->robot, "hardware:FILE: check the devices that FILE names; moves nothing");
  robot->check(NotEmpty)->excludes(licenses);
  doctor->add_option("--scenario", flags->scenario, "whose cameras these are; default corridor_loop")->needs(robot);
  doctor->add_flag("--json", flags->json, "for machines");
  doctor->callback([flags, &exit_code] {
    exit_code = flags->robot.empty() ? Doctor(flags->licenses, flags->json)
                                     : CheckRobot(flags->robot, flags->scenario, flags->json);
  });
}

}  // namespace merlin::cli
