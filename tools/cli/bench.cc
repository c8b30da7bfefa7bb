// `merlin bench`: measures how long things take on this machine, and shows the limits beside the results.
#include "tools/register/bench.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "robot/base/error.h"
#include "tools/cli/commands.h"
#if MERLIN_TWIN
#include "tools/camera/bench.h"
#include "tools/physics/bench.h"
#include "tools/slam/bench.h"
#endif

namespace merlin::cli {
namespace {

struct BenchArguments {
  std::string what;
  int threads = 2;
  bool json = false;
};

template <class Result>
int Print(const Result& bench, bool json) {
  if (interrupted) return kInterrupted;
  fmt::print("{}", json ? ToJson(bench) : Table(bench));
  return kPass;
}

#if MERLIN_TWIN

int BenchTwin(const BenchArguments& arguments) {
  if (arguments.what == "physics") return Print(BenchPhysics(interrupted), arguments.json);
  if (arguments.what == "slam") return Print(BenchSlam(interrupted), arguments.json);
  return Print(BenchCamera(arguments.threads, interrupted), arguments.json);
}

#else

int BenchTwin(const BenchArguments&) { throw MachineError("this build has no twin (MERLIN_TWIN=OFF)"); }

#endif

int Bench(const BenchArguments& arguments) {
  return arguments.what == "register" ? Print(BenchRegister(interrupted), arguments.json) : BenchTwin(arguments);
}

}  // namespace

void AddBench(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = app.add_subcommand("bench", "how long things take on this machine");
  bench
      ->add_option(
          "what", arguments->what,
          "camera: frames and rays in corridor_26x21; physics: steps in room_7x10; slam: filter to pose, and a lap "
          "that closes a loop; register: clouds, beside small_gicp")
      ->required()
      ->check(CLI::IsMember({"camera", "physics", "register", "slam"}));
  bench->add_option("--threads", arguments->threads, "of the cameras, measured beside one thread; default 2")
      ->check(CLI::Range(1, 256));
  bench->add_flag("--json", arguments->json, "for machines");
  bench->callback([arguments, &exit_code] { exit_code = Bench(*arguments); });
}

}  // namespace merlin::cli
