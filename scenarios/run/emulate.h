// Serves the devices of a simulated car to other programs, which drive it like a real one (`merlin emulate`).
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "robot/types/trajectory.h"
#include "scenarios/run/run.h"

namespace merlin {

struct EmulateOptions {
  RunOptions run;                       // its scenario, gl and threads
  std::filesystem::path hardware_file;  // written once every device answers, removed at the end
  // Called with one sentence at a time: which devices are ready, that a program connects or leaves, that the car
  // stands.
  std::function<void(const std::string&)> say;
};

struct EmulateReport {
  Trajectory truth;  // T_world_base at 20 Hz from when the devices answered; stamps of the emulator's clock
  std::int64_t collisions = 0;
  std::string
      car_lost;  // why the car cannot drive any more, for example tipped over; empty if stop ended the emulation
};

// The first line of the hardware files that Emulate writes.
extern const char kEmulatedHardwareFile[];

// Runs until stop is set or the car is lost. Programs may drive one after another; when one ends, for whatever reason,
// the car brakes and stands. Throws InputError before the simulation starts if hardware_file cannot be written or was
// not written by an emulator, MachineError if a device does not answer, and any exception of the simulation.
EmulateReport Emulate(const EmulateOptions& options, const std::atomic<bool>& stop);

}  // namespace merlin
