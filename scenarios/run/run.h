// Runs a scenario: in the twin, in the twin behind its real drivers and protocols, or on the real car; judges it against the
// truth where there is one, and leaves its files.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>

#include "scenarios/config/scenario.h"
#include "scenarios/judge/result.h"
#include "scenarios/run/drive_loop.h"
#include "sim/color/renderer.h"

namespace merlin {

enum class RobotKind { kTwin, kEmulated, kHardware };

struct RunOptions {
  std::string name;  // of the scenario, for people and for result.json
  Scenario scenario;
  std::filesystem::path out;
  RobotKind robot = RobotKind::kTwin;
  std::filesystem::path hardware_file{};  // of kHardware
  sim::Gl gl = sim::Gl::kAuto;            // kOff: depth only
  int threads = 0;                        // TwinOptions::threads; 0: the twin chooses
  double pace = 0.0;                      // simulated over wall time not to be exceeded; 0: as fast as it goes
  std::function<void(Time now, double distance_m, const std::string& doing)> progress;  // a few times a second
  Hand hand{};                                                     // of an operator who drives; empty: the pilot does
  std::function<void(Time now, const HandStatus&)> hand_status{};  // at every tick that has a hand
};

struct RunReport {
  RunResult result;
  // What broke the run, or kept a file from being written; null: nothing. Whoever tells of the run rethrows it then: a
  // DeviceError, a MachineError (disk full), or another exception where it is our own fault. result.fault says the
  // same.
  std::exception_ptr error{};
  std::string gl_name;  // empty: without colour
  std::string note;     // one sentence the user should know; may be empty
};

// stop: set from a signal handler; the car stands, files are written, the verdict is kInterrupted.
// Throws InputError, MachineError (GL missing where the scenario requires colour, disk full) before anything is
// simulated or written that looks whole. From then on it throws nothing: the car stands, what can still be written is
// written, the verdict is kFail, and the report holds the error.
RunReport RunScenario(const RunOptions& options, const std::atomic<bool>& stop);

}  // namespace merlin
