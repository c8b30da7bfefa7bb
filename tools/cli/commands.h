// The subcommands of `merlin`, one file each. Each adds itself to the command line and sets its exit code when chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>

namespace merlin::cli {

// Exit codes, the same for every subcommand.
enum ExitCode { kPass = 0, kFail = 1, kBadInput = 2, kCannot = 3, kOurFault = 4, kInterrupted = 130 };

// Set by Ctrl-C.
extern std::atomic<bool> interrupted;

void AddRun(CLI::App& app, int& exit_code);
void AddCamera(CLI::App& app, int& exit_code);
void AddCalibrate(CLI::App& app, int& exit_code);
void AddBench(CLI::App& app, int& exit_code);
void AddList(CLI::App& app, int& exit_code);
void AddDoctor(CLI::App& app, int& exit_code);

}  // namespace merlin::cli
