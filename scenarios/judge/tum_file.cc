#include "scenarios/judge/tum_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "robot/types/error.h"
#include "robot/types/text_fields.h"

namespace merlin {
namespace {

constexpr double kLargest_m = 1e9;
constexpr double kLastStamp_s = 9e9;     // what a Time holds; Unix time until 2255
constexpr double kUnitTolerance = 1e-3;  // files of four digits stay below
constexpr double kShortestQuaternion = 1e-6;

struct Match {
  std::size_t shorter = 0, longer = 0;
  Duration gap{0};
};

// One to one, ascending: of neighbours that want the same pose the nearer keeps it.
std::vector<Match> Matches(const Trajectory& shorter, const Trajectory& longer, Duration difference_max) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const Time stamp = shorter[i].stamp;
    auto nearest = std::ranges::lower_bound(longer, stamp, {}, &StampedPose::stamp);
    if (nearest == longer.end() ||
        (nearest != longer.begin() && stamp - (nearest - 1)->stamp <= nearest->stamp - stamp))
      --nearest;
    const Match match{.shorter = i,
                      .longer = static_cast<std::size_t>(nearest - longer.begin()),
                      .gap = std::chrono::abs(nearest->stamp - stamp)};
    if (match.gap > difference_max) continue;
    if (matches.empty() || matches.back().longer != match.longer)
      matches.push_back(match);
    else if (match.gap < matches.back().gap)
      matches.back() = match;
  }
  return matches;
}

}  // namespace

TumFile ParseTum(std::string_view text, const std::string& name) {
  TumFile file;
  std::vector<std::size_t> off_unit;
  ForEachLine(text, [&](std::string_view line, std::size_t number) {
    TextFields fields(line, name, number);
    if (fields.AtEnd() || line.starts_with('#')) return;
    const Time stamp = FromSeconds(fields.Number("the stamp", kLastStamp_s));
    Eigen::Vector3d p;
    for (double& value : p) value = fields.Number("the position", kLargest_m);
    Eigen::Quaterniond q;
    for (double& value : q.coeffs()) value = fields.Number("the quaternion", kLargest_m);
    fields.RequireEnd("'stamp x y z qx qy qz qw'");
    if (!(q.norm() > kShortestQuaternion)) throw InputError(fields.where(), "a quaternion of no length");
    if (std::abs(q.norm() - 1.0) > kUnitTolerance) off_unit.push_back(number);
    if (!file.trajectory.empty() && stamp <= file.trajectory.back().stamp)
      throw InputError(fields.where(), "the stamp does not come after the one before it",
                       fmt::format("more than {:.9f} s", Seconds(file.trajectory.back().stamp)),
                       fmt::format("{:.9f} s", Seconds(stamp)));
    file.trajectory.push_back({stamp, Eigen::Translation3d(p) * q.normalized()});
  });
  if (file.trajectory.empty()) throw InputError(name, "no poses", "lines 'stamp x y z qx qy qz qw'");
  if (!off_unit.empty())
    file.warnings.push_back(fmt::format("{}: {} quaternion{} off unit length, normalised ({})", name, off_unit.size(),
                                        off_unit.size() == 1 ? "" : "s", LinesOf(off_unit)));
  return file;
}

std::vector<PosePair> PairAtNearestStamps(const Trajectory& truth, const Trajectory& estimate,
                                          Duration difference_max) {
  std::vector<PosePair> pairs;
  if (truth.empty() || estimate.empty()) return pairs;
  const bool from_truth = truth.size() < estimate.size();
  for (const Match& match :
       from_truth ? Matches(truth, estimate, difference_max) : Matches(estimate, truth, difference_max))
    pairs.push_back(
        {truth[from_truth ? match.shorter : match.longer].T, estimate[from_truth ? match.longer : match.shorter].T});
  return pairs;
}

}  // namespace merlin
