// `merlin doctor`.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "robot/types/error.h"
#include "scenarios/hardware_file.h"
#include "tools/cli/commands.h"
#include "tools/cli/doctor.h"

namespace merlin::cli {
namespace {

constexpr Duration kListen = std::chrono::seconds(3);  // to each device

// The devices of a real car, each by itself.
int CheckRobot(const std::string& robot, const std::string& scenario) {
  const std::string hardware = "hardware:";
  if (!robot.starts_with(hardware) || robot.size() == hardware.size())
    throw InputError("--robot", "no devices to check", "hardware:FILE, which names them", "'" + robot + "'");
  const HardwareConfig config = ReadHardwareFile(robot.substr(hardware.size()));
  bool well = true;
  for (const DeviceReport& report : CheckDevices(config, CamerasOf(ReadScenario(scenario, {})), kListen)) {
    fmt::print("{}\n", report.complaint.empty() ? report.device + ": works" : report.complaint);
    well &= report.complaint.empty();
  }
  return well ? kPass : kCannot;
}

}  // namespace

void AddDoctor(CLI::App& app, int& exit_code) {
  struct Flags {
    bool licenses = false, json = false;
    std::string robot, scenario = "corridor_loop";
  };
  const auto flags = std::make_shared<Flags>();
  CLI::App* doctor = app.add_subcommand("doctor", "what works here: GL back ends, devices, versions, licences");
  doctor->add_flag("--licenses", flags->licenses, "everything linked, and its terms");
  doctor->add_option("--robot", flags->robot, "hardware:FILE: check the devices that FILE names; moves nothing");
  doctor->add_option("--scenario", flags->scenario, "whose cameras these are; default corridor_loop");
  doctor->add_flag("--json", flags->json, "for machines");
  doctor->callback([flags, &exit_code] {
    exit_code = flags->robot.empty() ? Doctor(flags->licenses, flags->json) : CheckRobot(flags->robot, flags->scenario);
  });
}

}  // namespace merlin::cli
