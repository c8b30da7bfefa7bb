// `merlin register`: aligns two point clouds from files, and tells how well they fit.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "scenarios/judge/output_path.h"
#include "scenarios/judge/writers.h"
#include "slam/register/align.h"
#include "tools/cli/commands.h"
#include "tools/cloud/cloud_file.h"
#include "tools/cloud/text.h"
#include "tools/cloud/write_cloud.h"

namespace merlin::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kMethodNames[] = {"point", "plane", "gicp", "auto"};

struct RegisterArguments {
  std::string source, target, method = "auto", guess, out;
  std::optional<double> max_distance_m, voxel_m;
  bool json = false;
};

struct Clouds {
  CloudFile source, target;
  ThinPair thin;  // as registered
};

[[noreturn]] void RefuseGuess(const std::string& text, const std::string& why) {
  throw InputError("--guess", why, "x,y,z,roll,pitch,yaw in metres and radians, or the 16 numbers of a pose row by row",
                   Quoted(text));
}

Pose ReadGuess(const std::string& text) {
  if (text.empty()) return Pose::Identity();
  std::vector<std::string_view> parts;
  cloud_text::SplitAt(',', text, parts);
  std::vector<double> n;
  for (const std::string_view part : parts) {
    n.push_back(cloud_text::ToNumber<double>(part).value_or(NAN));
    if (!(std::abs(n.back()) <= 1e9)) RefuseGuess(text, "no such value");
  }
  if (n.size() != 6 && n.size() != 16) RefuseGuess(text, "another count of numbers");
  Pose guess = Pose::Identity();
  if (n.size() == 6) {
    guess.translation() << n[0], n[1], n[2];
    guess.linear() =
        (Eigen::AngleAxisd(n[5], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(n[4], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(n[3], Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    return guess;
  }
  guess.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data());
  // Numbers that people copy are rounded.
  const Eigen::Matrix3d R = guess.linear();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-2 || R.determinant() < 0.0 ||
      guess.matrix().row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0))
    RefuseGuess(text, "not a rotation and a translation");
  guess.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  return guess;
}

CloudFile ReadPoints(const std::string& file) {
  CloudFile points = ReadCloud(file);
  if (points.cloud.size() >= 3) return points;
  throw InputError(file, "too few points", "3 or more",
                   std::to_string(points.cloud.size()) +
                       (points.left_out ? ", with " + std::to_string(points.left_out) + " left out" : ""));
}

AlignConfig ConfigOf(const RegisterArguments& a) {
  AlignConfig config;
  config.max_distance_m = a.max_distance_m.value_or(0.0);
  config.method = static_cast<AlignMethod>(std::ranges::find(kMethodNames, a.method) - std::begin(kMethodNames));
  return config;
}

std::string Words(const AlignResult& result) {
  switch (result.end) {
    case AlignEnd::kConverged:
      return "converged";
    case AlignEnd::kTooFewPairs:
      return "not converged: too few pairs";
    case AlignEnd::kUndetermined:
      return fmt::format("not converged: {} of 6 directions are not held", result.undetermined.count());
    case AlignEnd::kIterations:
      return "not converged: still moving at the last iteration";
  }
  return "";
}

ordered_json Rows(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  ordered_json numbers = ordered_json::array();
  for (int i = 0; i < matrix.rows(); ++i)
    for (int j = 0; j < matrix.cols(); ++j) numbers.push_back(matrix(i, j));
  return numbers;
}

std::vector<std::string> Warnings(const Clouds& clouds) {
  std::vector<std::string> warnings = clouds.source.warnings;
  warnings.insert(warnings.end(), clouds.target.warnings.begin(), clouds.target.warnings.end());
  return warnings;
}

std::string Json(const AlignResult& r, const Clouds& clouds, double time_ms) {
  ordered_json open = ordered_json::array();
  for (const auto& direction : r.undetermined.directions.colwise()) open.push_back(Rows(direction));
  return ordered_json{{"T_target_source", Rows(r.T_target_source.matrix())},
                      {"converged", r.converged()},
                      {"ended", Words(r)},
                      {"rms_m", r.rms_m},
                      {"overlap", r.overlap},
                      {"inliers", r.inliers},
                      {"iterations", r.iterations},
                      {"time_ms", time_ms},
                      {"method", kMethodNames[static_cast<int>(r.method)]},
                      {"max_distance_m", r.max_distance_m},
                      {"voxel_m", clouds.thin.voxel_m},
                      {"covariance", Rows(r.covariance)},
                      {"undetermined", open},
                      {"points", {clouds.thin.source.size(), clouds.thin.target.size()}},
                      {"left_out", {clouds.source.left_out, clouds.target.left_out}},
                      {"warnings", Warnings(clouds)}}
             .dump(-1, ' ', false, ordered_json::error_handler_t::replace) +
         "\n";
}

std::string Text(const AlignResult& r, const Clouds& clouds, double time_ms) {
  // Enough digits for a point that is 1e9 m away.
  std::string text = "T_target_source\n";
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) text += fmt::format(" {:20.15f}", r.T_target_source.matrix()(i, j));
    text += "\n";
  }
  text += fmt::format("{}\n{} of {} source points have a target point within {:.4g} m (overlap {:.3f}), rms {:.4g} m\n",
                      Words(r), r.inliers, clouds.thin.source.size(), r.max_distance_m, r.overlap, r.rms_m);
  for (const auto& d : r.undetermined.directions.colwise())
    text += fmt::format("not held: move {:.3f} {:.3f} {:.3f}, turn {:.3f} {:.3f} {:.3f}\n", d(0), d(1), d(2), d(3),
                        d(4), d(5));
  if (clouds.source.left_out + clouds.target.left_out > 0)
    text += fmt::format("left out: {} and {} points whose coordinates are empty, not finite or beyond 1e9 m\n",
                        clouds.source.left_out, clouds.target.left_out);
  const std::string thinned =
      clouds.thin.voxel_m > 0.0 ? fmt::format(" (voxels of {:.3g} m)", clouds.thin.voxel_m) : "";
  return text + fmt::format("{}: {} onto {} points{}, {} iterations, {:.1f} ms\n",
                            kMethodNames[static_cast<int>(r.method)], clouds.thin.source.size(),
                            clouds.thin.target.size(), thinned, r.iterations, time_ms);
}

// The complete source in the target's frame.
void WriteAligned(const std::string& out, const CloudFile& source, const Pose& T_target_source) {
  std::vector<Eigen::Vector3d> positions = source.cloud.positions;
  for (Eigen::Vector3d& position : positions) position = T_target_source * position;
  WriteFile(out, ToCloud(out, positions, source.rgb));
}

// NaN passes CLI11's own check of a range.
void CheckLength(const char* option, const std::optional<double>& length_m) {
  if (length_m && !(*length_m > 0.0 && *length_m <= 1e9))
    throw InputError(option, "no such length", "metres above 0, up to 1e9", fmt::format("{:g}", *length_m));
}

int Register(const RegisterArguments& a) {
  CheckLength("--max-distance", a.max_distance_m);
  CheckLength("--voxel", a.voxel_m);
  const Pose guess = ReadGuess(a.guess);
  if (!a.out.empty()) CheckOutputFile(a.out);
  Clouds clouds{ReadPoints(a.source), ReadPoints(a.target), {}};
  clouds.thin = a.voxel_m
                    ? ThinPair{Thin(clouds.source.cloud, *a.voxel_m), Thin(clouds.target.cloud, *a.voxel_m), *a.voxel_m}
                    : ThinToFit(clouds.source.cloud, clouds.target.cloud);
  if (interrupted) return kInterrupted;
  const AlignConfig config = ConfigOf(a);
  const auto begin = std::chrono::steady_clock::now();
  const AlignResult result = Align(clouds.thin.source, clouds.thin.target, guess, config);
  const double time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  if (interrupted) return kInterrupted;
  if (!a.out.empty()) WriteAligned(a.out, clouds.source, result.T_target_source);
  for (const std::string& warning : a.json ? std::vector<std::string>() : Warnings(clouds))
    fmt::print(stderr, "merlin: warning: {}\n", warning);
  fmt::print("{}", a.json ? Json(result, clouds, time_ms) : Text(result, clouds, time_ms));
  return result.converged() ? kPass : kFail;
}

}  // namespace

void AddRegister(CLI::App& app, int& exit_code) {
  const auto a = std::make_shared<RegisterArguments>();
  CLI::App* reg =
      app.add_subcommand("register", "aligns two clouds: finds T_target_source, p_target = T_target_source * p_source");
  reg->add_option("source", a->source,
                  "PLY, PCD, or text (.csv, .txt, .xyz, .asc, .pts: x y z, with or without a header), in metres")
      ->required();
  reg->add_option("target", a->target, "likewise; stays where it is")->required();
  reg->add_option("--method", a->method, "how a pair is measured; default gicp where there are surfaces, else point")
      ->check(CLI::IsMember({"point", "plane", "gicp"}));
  reg->add_option("--max-distance", a->max_distance_m,
                  "M: points farther apart are no pair; default 1/20 of the target's diagonal, 1/4 with point");
  reg->add_option("--guess", a->guess,
                  "T_target_source: x,y,z,roll,pitch,yaw (m, rad), or 16 numbers row by row; default none");
  reg->add_option("--voxel", a->voxel_m,
                  "M: thins both to one point a cube of this edge; default: what leaves at most 20,000 points of each");
  reg->add_option("--out", a->out,
                  "PLY (PCD, CSV by its name): the source in the target's frame, also where it did not converge")
      ->check(NotEmpty);
  reg->add_flag("--json", a->json, "for machines");
  reg->footer("exit code: 0 converged, 1 not (few pairs, or a direction that the clouds do not hold), 2 bad input");
  reg->callback([a, &exit_code] { exit_code = Register(*a); });
}

}  // namespace merlin::cli
