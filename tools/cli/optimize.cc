// `merlin optimize`: solves a pose graph and prints the values of both objectives at the solution.
#include "slam/graph/optimize.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "robot/base/files.h"
#include "scenarios/judge/output_path.h"
#include "scenarios/judge/writers.h"
#include "slam/graph/g2o_file.h"
#include "slam/graph/initial_poses.h"
#include "slam/graph/parts.h"
#include "tools/cli/commands.h"

namespace merlin::cli {
namespace {

struct OptimizeArguments {
  std::string graph, objective = "b", out;
  bool json = false;
};

double Now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Solution {
  G2oFile file;
  std::size_t parts = 0;
  bool converged = true;
  int iterations = 0;
  double time_s = 0.0, iteration_ms = 0.0;
};

// Solves each connected part of the graph by itself, so that each converges by its own objective.
Solution Solve(const OptimizeArguments& arguments) {
  const double begin_s = Now_s();
  Solution solution{.file = ParseG2o(ReadFile(arguments.graph, "a pose graph (g2o)"), arguments.graph)};
  std::vector<GraphPart> parts = PartsOf(solution.file.graph);
  solution.parts = parts.size();
  bool open = false;
  for (GraphPart& part : parts) {
    if (auto poses = ChordalPoses(part.graph))
      part.graph.poses = *std::move(poses);
    else
      open = true;
  }
  if (open)
    solution.file.warnings.push_back(arguments.graph +
                                     ": edges of no weight leave the chordal start open; started at the " +
                                     (solution.file.has_poses ? "file's poses" : "poses chained along the edges"));
  const double start_s = Now_s();
  const Objective objective = arguments.objective == "a" ? Objective::kA : Objective::kB;
  for (GraphPart& part : parts) {
    OptimizeResult result = Optimize(part.graph, {}, objective, &interrupted);
    part.graph.poses = std::move(result.poses);
    PutPoses(part, solution.file.graph);
    solution.converged = solution.converged && result.converged;
    solution.iterations += result.iterations;
  }
  const double end_s = Now_s();
  solution.time_s = end_s - begin_s;
  solution.iteration_ms = 1e3 * (end_s - start_s) / std::max(1, solution.iterations);
  return solution;
}

void Print(const OptimizeArguments& arguments, const Solution& solution) {
  const PoseGraph& graph = solution.file.graph;
  const double a = Evaluate(graph, Objective::kA), b = Evaluate(graph, Objective::kB);
  if (arguments.json) {
    const nlohmann::ordered_json whole{{"file", arguments.graph},
                                       {"poses", graph.poses.size()},
                                       {"edges", graph.edges.size()},
                                       {"parts", solution.parts},
                                       {"planar", graph.planar},
                                       {"objective", arguments.objective},
                                       {"objective_a", a},
                                       {"objective_b", b},
                                       {"converged", solution.converged},
                                       {"iterations", solution.iterations},
                                       {"time_s", solution.time_s},
                                       {"iteration_ms", solution.iteration_ms},
                                       {"warnings", solution.file.warnings}};
    fmt::print("{}\n", whole.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  for (const std::string& warning : solution.file.warnings) fmt::print(stderr, "merlin: warning: {}\n", warning);
  fmt::print("{} poses, {} edges in the {}; at the optimum of {}:\n", graph.poses.size(), graph.edges.size(),
             graph.planar ? "plane" : "space", arguments.objective == "a" ? "A" : "B");
  fmt::print("  objective A  {:.9g}\n  objective B  {:.9g}\n", a, b);
  fmt::print("  {} after {} iterations of {:.2f} ms; {:.3f} s with reading and chordal start\n",
             solution.converged ? "converged" : "NOT converged", solution.iterations, solution.iteration_ms,
             solution.time_s);
  if (!arguments.out.empty()) fmt::print("file: {}\n", arguments.out);
}

int RunOptimize(const OptimizeArguments& arguments) {
  if (!arguments.out.empty()) CheckOutputFile(arguments.out);
  const Solution solution = Solve(arguments);
  if (interrupted) return kInterrupted;
  if (!arguments.out.empty()) WriteFile(arguments.out, ToG2o(solution.file));
  Print(arguments, solution);
  return solution.converged ? kPass : kFail;
}

}  // namespace

void AddOptimize(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<OptimizeArguments>();
  CLI::App* optimize = app.add_subcommand("optimize", "solves a pose graph (g2o); exit 1 where it does not converge");
  optimize
      ->add_option("graph", arguments->graph,
                   "VERTEX_SE2 and EDGE_SE2, or the same with SE3:QUAT; FIX; VERTEX may be missing")
      ->required();
  optimize
      ->add_option("--objective", arguments->objective,
                   "what is minimised. a: isotropic, as SE-Sync has it; b: chi2, as g2o has it; default b")
      ->check(CLI::IsMember({"a", "b"}));
  optimize->add_option("--out", arguments->out, "writes the solved graph there")->check(NotEmpty);
  optimize->add_flag("--json", arguments->json, "for machines");
  optimize->callback([arguments, &exit_code] { exit_code = RunOptimize(*arguments); });
}

}  // namespace merlin::cli
