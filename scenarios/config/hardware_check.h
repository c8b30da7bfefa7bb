// Checks of a hardware file that involve more than one key.
#pragma once

#include <filesystem>

#include "robot/hardware/hardware_robot.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// Throws InputError if two devices have the same port, also under different names (links). file: for the message.
void RequireDistinctDevices(const HardwareConfig& config, const std::filesystem::path& file);

// Throws InputError if the file belongs to another car than the scenario, or lacks a colour camera that the scenario
// requires.
void RequireFits(const HardwareConfig& config, const Scenario& scenario, const std::filesystem::path& file);

}  // namespace merlin
