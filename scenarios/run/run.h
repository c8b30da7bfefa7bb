// Runs a scenario on a robot behind a plug (robot/hal/plug.h): drives, judges the result against the truth if it is
// known, and writes the files.
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
  std::string name;  // of the scenario, for messages and result.json
  Scenario scenario;
  std::filesystem::path out;
  RobotKind robot = RobotKind::kTwin;
  std::filesystem::path hardware_file{};            // for kHardware
  Gl gl = Gl::kAuto;                                // for the twin; kOff: depth only
  int threads = 0;                                  // for the twin: TwinOptions::threads; 0: the twin chooses
  double pace = 0.0;                                // largest ratio of simulated to wall time; 0: as fast as possible
  std::function<void(const LoopState&)> progress;   // called a few times a second
  ManualInput manual{};                             // an operator's input; empty: the pilot drives
  std::function<void(const LoopState&)> station{};  // called at every tick, for the operator's display
};

struct RunReport {
  RunResult result;
  // The exception that ended the run or kept a file from being written; null if there was none. The caller rethrows it
  // after reporting: a DeviceError, a MachineError (disk full), or another exception for a fault of this program.
  // result.fault says the same in words.
  std::exception_ptr error{};
  std::string gl_name;  // name of the GL back end; empty without colour
  std::string note;     // a note to the user; may be empty
};

// Makes the plug for the options, ready to drive. Throws InputError or MachineError before anything moves.
using PlugMaker = std::function<std::unique_ptr<Plug>(const RunOptions&)>;

// stop: set by a signal handler; the car then stops, the files are written, and the verdict is kInterrupted.
// Throws InputError or MachineError (no GL although the scenario requires colour, disk full) before anything moves and
// before any complete file is written. After that it does not throw: on an error the car stops, everything that can
// still be written is written, the verdict is kFail, and the report holds the error.
RunReport RunScenario(const RunOptions& options, const PlugMaker& make_plug, const std::atomic<bool>& stop);

}  // namespace merlin
