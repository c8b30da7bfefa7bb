// The subcommands of `merlin`, one file each. Each adds itself to the command line and sets its exit code when chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <string>

namespace merlin::cli {

// Exit codes, the same for every subcommand.
enum ExitCode { kPass = 0, kFail = 1, kBadInput = 2, kCannot = 3, kOurFault = 4, kInterrupted = 130 };

// Set by Ctrl-C.
extern std::atomic<bool> interrupted;

void AddRun(CLI::App& app, int& exit_code);
void AddDrive(CLI::App& app, int& exit_code);
void AddEmulate(CLI::App& app, int& exit_code);
void AddCamera(CLI::App& app, int& exit_code);
void AddCalibrate(CLI::App& app, int& exit_code);
void AddRegister(CLI::App& app, int& exit_code);
void AddBench(CLI::App& app, int& exit_code);
void AddOptimize(CLI::App& app, int& exit_code);
void AddEval(CLI::App& app, int& exit_code);
void AddSweep(CLI::App& app, int& exit_code);
void AddList(CLI::App& app, int& exit_code);
void AddDoctor(CLI::App& app, int& exit_code);

// For CLI11's checks: what is wrong with a text, or nothing.
inline std::string NotEmpty(const std::string& text) { return text.empty() ? "expected a value, got nothing" : ""; }
inline std::string WholeNumber(const std::string& text) {
  const bool whole = !text.empty() && text.size() <= 20 && text.find_first_not_of("0123456789") == std::string::npos;
  return whole ? "" : "expected a whole number from 0 on, got '" + text + "'";
}

}  // namespace merlin::cli
