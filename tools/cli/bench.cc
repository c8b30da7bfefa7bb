// `merlin bench`: how long things take on this machine, beside what they may take.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "robot/types/error.h"
#include "tools/cli/commands.h"
#if MERLIN_TWIN
#include "tools/camera/bench.h"
#endif

namespace merlin::cli {
namespace {

struct Arguments {
  std::string what;
  int threads = 2;
  bool json = false;
};

#if MERLIN_TWIN

int Bench(const Arguments& arguments) {
  const CameraBench bench = BenchCamera(arguments.threads, interrupted);
  if (interrupted) return kInterrupted;
  fmt::print("{}", arguments.json ? ToJson(bench) : Table(bench));
  return kPass;
}

#else

int Bench(const Arguments&) { throw MachineError("this build has no twin (MERLIN_TWIN=OFF)"); }

#endif

}  // namespace

void AddBench(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* bench = app.add_subcommand("bench", "how long things take on this machine");
  bench->add_option("what", arguments->what, "camera: frames and rays in corridor_26x21")
      ->required()
      ->check(CLI::IsMember({"camera"}));
  bench->add_option("--threads", arguments->threads, "measured beside one thread; default 2")
      ->check(CLI::Range(1, 256));
  bench->add_flag("--json", arguments->json, "for machines");
  bench->callback([arguments, &exit_code] { exit_code = Bench(*arguments); });
}

}  // namespace merlin::cli
