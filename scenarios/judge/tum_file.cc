#include "scenarios/judge/tum_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "robot/base/text_fields.h"

namespace merlin {
namespace {

constexpr double kLargest_m = 1e9;
constexpr double kLastStamp_s = 9e9;     // within the range of Time; Unix time until 2255
constexpr double kUnitTolerance = 1e-3;  // rounding to four digits stays below
constexpr double kShortestQuaternion = 1e-6;

struct Match {
  std::size_t shorter = 0, longer = 0;
};

// The same steps as evo's matching_time_indices (evo/core/sync.py of 1.38), also in doubles, so that equal stamps and
// stamps halfway between two are paired as in evo.
std::vector<Match> Matches(const Trajectory& shorter, const Trajectory& longer, Duration difference_max) {
  const double most_s = Seconds(difference_max);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const Time stamp = shorter[i].stamp;
    const double stamp_s = Seconds(stamp);
    if (stamp_s < Seconds(longer.front().stamp) - most_s || stamp_s > Seconds(longer.back().stamp) + most_s) continue;
    auto above = std::ranges::upper_bound(longer, stamp, {}, &StampedPose::stamp);
    if (above == longer.end()) --above;
    const double gap_above_s = Seconds(above->stamp) - stamp_s;  // negative beyond the end
    const double gap_below_s = above == longer.begin() ? HUGE_VAL : stamp_s - Seconds((above - 1)->stamp);
    const bool take_above = gap_above_s <= most_s && gap_above_s < gap_below_s;
    if (!take_above && gap_below_s > most_s) continue;
    if (!take_above) --above;
    matches.push_back({.shorter = i, .longer = static_cast<std::size_t>(above - longer.begin())});
  }
  return matches;
}

void Warn(TumFile& file, const std::string& name, const std::vector<std::size_t>& lines, const char* one,
          const char* many, const char* what) {
  if (!lines.empty())
    file.warnings.push_back(
        fmt::format("{}: {} {} {} ({})", name, lines.size(), lines.size() == 1 ? one : many, what, LinesOf(lines)));
}

}  // namespace

TumFile ParseTum(std::string_view text, const std::string& name) {
  TumFile file;
  FaultList faults(name);
  std::vector<std::size_t> off_unit, again;
  const auto read = [&](std::string_view line, std::size_t number) {
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
    if (!file.trajectory.empty() && stamp < file.trajectory.back().stamp)
      throw InputError(fields.where(), "the stamp comes before the one above it",
                       fmt::format("{:.9f} s or more", Seconds(file.trajectory.back().stamp)),
                       fmt::format("{:.9f} s", Seconds(stamp)));
    if (!file.trajectory.empty() && stamp == file.trajectory.back().stamp) again.push_back(number);
    file.trajectory.push_back({stamp, Eigen::Translation3d(p) * q.normalized()});
  };
  ForEachLine(text, [&](std::string_view line, std::size_t number) { faults.Try([&] { read(line, number); }); });
  faults.ThrowIfAny();
  if (file.trajectory.empty()) throw InputError(name, "no poses", "lines 'stamp x y z qx qy qz qw'");
  Warn(file, name, off_unit, "quaternion", "quaternions", "off unit length, normalised");
  Warn(file, name, again, "stamp is", "stamps are",
       "that of the pose above; all its poses are taken, and paired as evo does");
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
