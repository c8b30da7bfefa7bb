// The file that names a real car's devices: `--robot hardware:FILE`.
#pragma once

#include <filesystem>

#include "robot/hardware/hardware_robot.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// YAML: a map for each device (drive, compass, depth, color, clock), its keys those of the device's config. Throws
// InputError: no such file, broken YAML, an unknown key (names the nearest), a value out of its range; all at once. Also
// where it names a device twice.
HardwareConfig ReadHardwareFile(const std::filesystem::path& yaml);

// Such a file's text, with every default written out.
std::string ToYaml(const HardwareConfig& config);

// What the scenario says of the cameras, and where the car's description has them.
HardwareCameras CamerasOf(const Scenario& scenario);

// The depth camera's settings that a scenario asks for; those to begin with where its integration time is automatic.
DepthSettings SettingsOf(const DepthSensor& sensor, const DepthCameraSheet& sheet);

}  // namespace merlin
