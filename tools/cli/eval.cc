// `merlin eval`: measures the error of an estimated trajectory, with the same figures as the evo package.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "scenarios/judge/alignment.h"
#include "scenarios/judge/tum_file.h"
#include "tools/cli/commands.h"

namespace merlin::cli {
namespace {

struct EvalArguments {
  std::string truth, estimate, align = "se3";
  double delta_m = 1.0, max_difference_s = 0.02;
  bool json = false;
};

struct Evaluation {
  std::vector<std::string> warnings;
  std::size_t truth_poses = 0, estimate_poses = 0, pairs = 0, relative_pairs = 0;
  Ate ate;
  std::optional<ErrorStatistics> translation_m{}, rotation_deg{};
};

Alignment AlignmentOf(const std::string& name) {
  if (name == "none") return Alignment::kNone;
  return name == "sim3" ? Alignment::kSim3 : Alignment::kSe3;
}

std::string Span(const Trajectory& trajectory) {
  return fmt::format("{:.3f} to {:.3f} s", Seconds(trajectory.front().stamp), Seconds(trajectory.back().stamp));
}

// Whether all positions are the same, apart from rounding in the file. There must be at least one pair.
bool InOnePlace(const std::vector<PosePair>& pairs, Pose PosePair::*side) {
  constexpr double kSame_m = 1e-6;
  return std::ranges::all_of(pairs, [&](const PosePair& pair) {
    return ((pair.*side).translation() - (pairs.front().*side).translation()).norm() <= kSame_m;
  });
}

// An alignment needs at least three positions that are not all the same.
void CheckPairs(const EvalArguments& arguments, const std::vector<PosePair>& pairs) {
  if (pairs.size() < 3)
    throw InputError(
        arguments.estimate, "too few pairs for a figure",
        fmt::format("3 or more stamps within {} s of one of {}", arguments.max_difference_s, arguments.truth),
        fmt::format("{}", pairs.size()));
  for (const auto& [file, side] :
       {std::pair{arguments.truth, &PosePair::T_world_base}, std::pair{arguments.estimate, &PosePair::T_map_base}})
    if (InOnePlace(pairs, side))
      throw InputError(
          file,
          fmt::format("the positions of all {} pairs are in one place: nothing tells turn or scale", pairs.size()),
          "a path");
}

Evaluation Evaluate(const EvalArguments& arguments) {
  const auto read = [](const std::string& file) { return ParseTum(ReadFile(file, "a trajectory (TUM)"), file); };
  const TumFile truth = read(arguments.truth), estimate = read(arguments.estimate);
  const std::vector<PosePair> pairs =
      PairAtNearestStamps(truth.trajectory, estimate.trajectory, FromSeconds(arguments.max_difference_s));
  if (pairs.empty())
    throw InputError(arguments.estimate,
                     fmt::format("no stamp within {} s of one of {}", arguments.max_difference_s, arguments.truth),
                     Span(truth.trajectory), Span(estimate.trajectory));
  CheckPairs(arguments, pairs);
  const std::optional<Ate> ate = AlignAndAte(pairs, AlignmentOf(arguments.align));
  if (!ate) throw InputError(arguments.estimate, "nothing tells its scale");

  Evaluation evaluation{.warnings = truth.warnings,
                        .truth_poses = truth.trajectory.size(),
                        .estimate_poses = estimate.trajectory.size(),
                        .pairs = pairs.size(),
                        .ate = *ate};
  evaluation.warnings.insert(evaluation.warnings.end(), estimate.warnings.begin(), estimate.warnings.end());
  RelativeErrors errors = ErrorsOver(pairs, arguments.delta_m, ate->scale);
  evaluation.relative_pairs = errors.translation_m.size();
  if (errors.translation_m.empty()) return evaluation;
  for (double& error : errors.rotation_rad) error *= 180.0 / std::numbers::pi;
  evaluation.translation_m = StatisticsOf(errors.translation_m);
  evaluation.rotation_deg = StatisticsOf(errors.rotation_rad);
  return evaluation;
}

// visit(name, value) for each figure.
template <class Visit>
void VisitFigures(const ErrorStatistics& error, Visit visit) {
  visit("rmse", error.rmse);
  visit("mean", error.mean);
  visit("median", error.median);
  visit("std", error.spread);
  visit("min", error.min);
  visit("max", error.max);
}

void PrintJson(const EvalArguments& arguments, const Evaluation& evaluation) {
  nlohmann::ordered_json whole{{"truth", arguments.truth},
                               {"estimate", arguments.estimate},
                               {"truth_poses", evaluation.truth_poses},
                               {"estimate_poses", evaluation.estimate_poses},
                               {"max_difference_s", arguments.max_difference_s},
                               {"pairs", evaluation.pairs},
                               {"align", arguments.align},
                               {"scale", evaluation.ate.scale}};
  const auto add = [&whole](const std::string& prefix, const std::string& unit,
                            const std::optional<ErrorStatistics>& error) {
    VisitFigures(error.value_or(ErrorStatistics{}), [&](const char* name, double value) {
      nlohmann::ordered_json& figure = whole[prefix + name + unit];
      if (error) figure = value;
    });
  };
  add("ate_", "_m", evaluation.ate.error_m);
  whole["delta_m"] = arguments.delta_m;
  whole["rpe_pairs"] = evaluation.relative_pairs;
  add("rpe_translation_", "_m", evaluation.translation_m);
  add("rpe_rotation_", "_deg", evaluation.rotation_deg);
  whole["warnings"] = evaluation.warnings;
  fmt::print("{}\n", whole.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void PrintText(const EvalArguments& arguments, const Evaluation& evaluation) {
  for (const std::string& warning : evaluation.warnings) fmt::print(stderr, "merlin: warning: {}\n", warning);
  fmt::print("{} pairs within {} s, of {} true and {} estimated poses; aligned: {}", evaluation.pairs,
             arguments.max_difference_s, evaluation.truth_poses, evaluation.estimate_poses, arguments.align);
  if (arguments.align == "sim3") fmt::print(", scale {:.6f}", evaluation.ate.scale);
  fmt::print("\n{:24}", "");
  VisitFigures({}, [](const char* name, double) { fmt::print("{:>11}", name); });
  const auto row = [](const char* name, const ErrorStatistics& error) {
    fmt::print("\n{:<24}", name);
    VisitFigures(error, [](const char*, double value) { fmt::print("{:>11.6f}", value); });
  };
  row("ATE [m]", evaluation.ate.error_m);
  if (evaluation.translation_m) {
    row("RPE, translation [m]", *evaluation.translation_m);
    row("RPE, rotation [deg]", *evaluation.rotation_deg);
    fmt::print("\nRPE over {} m of the true path, {} pairs\n", arguments.delta_m, evaluation.relative_pairs);
  } else {
    fmt::print("\nno RPE: no two of these poses are {} m of the true path apart\n", arguments.delta_m);
  }
}

int Eval(const EvalArguments& arguments) {
  const Evaluation evaluation = Evaluate(arguments);
  arguments.json ? PrintJson(arguments, evaluation) : PrintText(arguments, evaluation);
  return kPass;
}

// CLI::Range lets NaN through.
auto Between(double min, double max) {
  return [min, max](const std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    const bool good = end == text.c_str() + text.size() && number >= min && number <= max;
    return good ? std::string() : fmt::format("expected a number from {} to {}, got '{}'", min, max, text);
  };
}

}  // namespace

void AddEval(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<EvalArguments>();
  CLI::App* eval = app.add_subcommand("eval", "how far an estimated trajectory lies from the true one: ATE, RPE");
  eval->add_option("truth", arguments->truth, "'stamp_s x y z qx qy qz qw' a line (TUM)")->required();
  eval->add_option("estimate", arguments->estimate, "the same")->required();
  eval->add_option("--align", arguments->align,
                   "what is done to the estimate before ATE: se3, sim3 (scale too) or none; default se3")
      ->check(CLI::IsMember({"se3", "sim3", "none"}));
  eval->add_option("--delta", arguments->delta_m, "length of true path that RPE is taken over [m]; default 1")
      ->check(Between(1e-6, 1e6));
  eval->add_option("--max-difference", arguments->max_difference_s,
                   "most that stamps of a pair may differ [s]; default 0.02")
      ->check(Between(0.0, 1e6));
  eval->add_flag("--json", arguments->json, "for machines");
  eval->callback([arguments, &exit_code] { exit_code = Eval(*arguments); });
}

}  // namespace merlin::cli
