// Runs a scenario on a robot behind a plug (robot/hal/plug.h): drives, judges against the truth where there is one, and
// leaves the files.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "robot/hal/plug.h"
#include "robot/types/gl.h"
#include "scenarios/config/scenario.h"
#include "scenarios/judge/result.h"
#include "scenarios/run/drive_loop.h"

namespace merlin {

enum class RobotKind { kTwin, kEmulated, kHardware };

struct RunOptions {
  std::string name;  // of the scenario, for people and for result.json
  Scenario scenario;
  std::filesystem::path out;
  RobotKind robot = RobotKind::kTwin;
  std::filesystem::path hardware_file{};           // of kHardware
  Gl gl = Gl::kAuto;                               // of the twin; kOff: depth only
  int threads = 0;                                 // of the twin: TwinOptions::threads; 0: the twin chooses
  double pace = 0.0;                               // simulated over wall time not to be exceeded; 0: as fast as it goes
  std::function<void(const LoopState&)> progress;  // a few times a second
  ManualInput manual{};                            // of an operator; empty: the pilot drives
  std::function<void(const LoopState&)> station{};  // at every tick: what an operator wants to know
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

// Makes the plug that the options ask for, ready to drive. Throws InputError or MachineError before anything moves.
using PlugMaker = std::function<std::unique_ptr<Plug>(const RunOptions&)>;

// stop: set from a signal handler; the car stands, files are written, the verdict is kInterrupted.
// Throws InputError, MachineError (GL missing where the scenario requires colour, disk full) before anything moves or is
// written that looks whole. From then on it throws nothing: the car stands, what can still be written is written, the
// verdict is kFail, and the report holds the error.
RunReport RunScenario(const RunOptions& options, const PlugMaker& make_plug, const std::atomic<bool>& stop);

}  // namespace merlin
