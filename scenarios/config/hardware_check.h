// What a hardware file must not say, beyond what each key allows by itself.
#pragma once

#include <filesystem>

#include "robot/hardware/hardware_robot.h"
#include "scenarios/config/scenario.h"

namespace merlin {

// Throws InputError where two devices are said to be at the same port, under whatever names of it. file: for the error.
void RequireDistinctDevices(const HardwareConfig& config, const std::filesystem::path& file);

// Throws InputError where the file is another car's than the scenario's, or names no colour camera and the scenario
// requires one.
void RequireFits(const HardwareConfig& config, const Scenario& scenario, const std::filesystem::path& file);

}  // namespace merlin
