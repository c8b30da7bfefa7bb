// The file that names a real car's devices: `--robot hardware:FILE`.
#pragma once

#include <filesystem>

#include "robot/hardware/hardware_robot.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// YAML with a map for each device (drive, compass, depth, color, clock), whose keys are the fields of the device's
// config. Throws InputError for a missing file, broken YAML, an unknown key (and suggests the nearest), or a value out
// of range; it lists all faults at once. Also throws if two devices have the same port.
HardwareConfig ReadHardwareFile(const std::filesystem::path& yaml);

// The text of a hardware file, with every default written out.
std::string ToYaml(const HardwareConfig& config);

// The cameras of a scenario: data sheets, rates and settings, and their poses from the car's description.
HardwareCameras CamerasOf(const Scenario& scenario);

// The depth camera's settings from a scenario. With automatic integration time: the settings to start with.
DepthSettings SettingsOf(const DepthSensor& sensor, const DepthCameraSheet& sheet);

}  // namespace merlin
