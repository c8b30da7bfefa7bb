#include "scenarios/config/hardware_check.h"

#include <map>
#include <string>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "scenarios/config/names.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

// Resolves links such as those in /dev/serial/by-id.
std::string RealPath(const std::string& port) {
  std::error_code unreadable;
  const fs::path real = fs::weakly_canonical(port, unreadable);
  return unreadable ? port : real.string();
}

}  // namespace

void RequireDistinctDevices(const HardwareConfig& config, const fs::path& file) {
  std::map<std::string, std::string> taken;  // port to device
  const auto take = [&](const std::string& device, const std::string& port) {
    if (port.empty()) return;
    const auto [other, is_new] = taken.emplace(RealPath(port), device);
    if (!is_new)
      throw InputError(file.string(), "names a device twice", "different ports for " + other->second + " and " + device,
                       port + " for both");
  };
  take("drive", config.drive.serial.port);
  if (config.compass) take("compass", config.compass->serial.port);
  if (config.color) take("color", config.color->source);
}

void RequireFits(const HardwareConfig& config, const Scenario& scenario, const fs::path& file) {
  const CarDescription car = ReadCar(CarFile(scenario.car.model));
  if (!config.car.empty() && config.car != car.name)
    throw InputError(file.string(), "these are the devices of another car", "'" + car.name + "', the scenario's",
                     "'" + config.car + "'");
  if (scenario.sensors.color && scenario.sensors.color->required && !config.color)
    throw InputError(file.string(), "names no colour camera",
                     "one, because the scenario needs it (sensors.color.required)");
}

}  // namespace merlin
