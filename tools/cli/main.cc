// The program `merlin`: finds the subcommand, and turns what it throws into one sentence and the documented exit code.
#include <signal.h>

#include <cstdio>
#include <exception>

#include "robot/base/error.h"
#include "tools/cli/commands.h"
#include "tools/cli/usage.h"
#include "tools/drive/raw_terminal.h"

namespace merlin::cli {

std::atomic<bool> interrupted{false};

namespace {

// The first Ctrl-C ends the run in good order; the second one ends the program at once.
void OnInterrupt(int) {
  if (!interrupted.exchange(true)) return;
  RestoreTerminal();
  _exit(kInterrupted);
}

int Main(int argc, char** argv) {
  CLI::App app("merlin: a digital twin of a car-like robot with a time-of-flight camera", "merlin");
  app.set_version_flag("--version", MERLIN_VERSION);
  app.require_subcommand(1);
  app.formatter(HelpFormatter());
  int exit_code = kPass;
  AddRun(app, exit_code);
  AddSweep(app, exit_code);
  AddDrive(app, exit_code);
  AddEmulate(app, exit_code);
  AddCamera(app, exit_code);
  AddCalibrate(app, exit_code);
  AddOptimize(app, exit_code);
  AddEval(app, exit_code);
  AddList(app, exit_code);
  AddRegister(app, exit_code);
  AddBench(app, exit_code);
  AddDoctor(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "merlin: %s (--help tells more)\n", Explain(app, error).c_str());
    return kBadInput;
  }
  return exit_code;
}

}  // namespace
}  // namespace merlin::cli

int main(int argc, char** argv) {
  struct sigaction action {};
  action.sa_handler = merlin::cli::OnInterrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);  // the car must not stop because the reader of our output has gone
  signal(SIGXFSZ, SIG_IGN);  // nor because a file cannot grow: the write reports it
  try {
    const int exit_code = merlin::cli::Main(argc, argv);
    if (std::fflush(stdout) != 0) throw merlin::MachineError("standard output cannot be written");
    return exit_code;
  } catch (const merlin::InputError& error) {
    std::fprintf(stderr, "merlin: %s\n", error.what());
    return merlin::cli::kBadInput;
  } catch (const merlin::MachineError& error) {
    std::fprintf(stderr, "merlin: %s\n", error.what());
    return merlin::cli::kCannot;
  } catch (const merlin::DeviceError& error) {
    std::fprintf(stderr, "merlin: %s\n", error.what());
    return merlin::cli::kFail;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "merlin: internal error: %s\n", error.what());
    return merlin::cli::kOurFault;
  } catch (...) {
    std::fprintf(stderr, "merlin: internal error\n");
    return merlin::cli::kOurFault;
  }
}
