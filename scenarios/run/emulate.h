// Serves the devices of a simulated car to other programs, which drive it as they would a real one (`merlin emulate`).
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
  std::filesystem::path hardware_file;  // is written once every device answers, and removed at the end
  // Called with one sentence at a time: what can be driven, who comes and goes, that the car stands.
  std::function<void(const std::string&)> say;
};

struct EmulateReport {
  Trajectory truth;  // T_world_base twenty times a second, since the devices answered; stamps: the emulator's clock
  std::int64_t collisions = 0;
  std::string car_lost;  // why nobody can drive it any more, such as a car that lies on its side; empty: stop ended it
};

// The first line of the hardware files that it writes.
extern const char kEmulatedHardwareFile[];

// Until stop is set or the car is lost. One program after the other may drive; when one goes, however it ends, the car
// brakes and stands. Throws InputError before anything is simulated where hardware_file cannot be written, or is a file
// that no emulator wrote; MachineError where a device does not answer; and what breaks the world.
EmulateReport Emulate(const EmulateOptions& options, const std::atomic<bool>& stop);

}  // namespace merlin
