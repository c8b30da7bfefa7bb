#include "scenarios/judge/measure.h"

#include <algorithm>

#include "scenarios/judge/alignment.h"
#include "scenarios/judge/laps.h"
#include "scenarios/judge/map_truth.h"

namespace merlin {
namespace {

StackTimes Percentiles(std::vector<double> ms) {
  if (ms.empty()) return {};
  std::ranges::sort(ms);
  const auto at = [&ms](double share) {
    return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
  };
  return {at(0.5), at(0.99), ms.back()};
}

// The metrics that compare path and map with the truth.
void Compare(const StackOutcome& outcome, const GroundTruth& truth, Measured& measured) {
  Metrics& metrics = measured.metrics;
  const std::vector<PosePair> pairs = PairAtEqualStamps(truth.path, outcome.estimate);
  if (const auto rpe = RpeOverOneMetre(pairs)) {
    metrics.rpe_translation_percent = rpe->translation_percent;
    metrics.rpe_rotation_deg_per_m = rpe->rotation_deg_per_m;
  }
  const auto ate = AlignAndAte(pairs);
  if (!ate) return;
  metrics.ate_rmse_m = ate->rmse_m;
  if (const auto driven = AlignAndAte(PairAtEqualStamps(truth.path, outcome.online)))
    metrics.ate_online_rmse_m = driven->rmse_m;
  measured.T_world_map = ate->T_world_map;
  measured.size = MeasureMapSize(outcome.map, ate->T_world_map, truth.outline_m);
  metrics.map_size_m = measured.size.size_m;
  metrics.map_size_error_percent = measured.size.error_percent;
  metrics.map_to_plan_p95_m = MapToPlanP95_m(outcome.map, ate->T_world_map, truth.range_m);
  metrics.coverage_percent = CoveragePercent(outcome.map, ate->T_world_map, truth.outline_m, truth.path, truth.range_m);
}

}  // namespace

Measured Measure(const StackOutcome& outcome, const GroundTruth* truth, FirstFault& faults) {
  Measured measured;
  Metrics& metrics = measured.metrics;
  metrics.distance_m = truth != nullptr ? PathLength_m(truth->path) : outcome.path_m;
  metrics.loops_closed = outcome.loops_closed;
  metrics.stack_ms = Percentiles(outcome.stack_ms);
  metrics.place_found_s = outcome.place_found_s;
  metrics.place_found_m = outcome.place_found_m;
  if (truth == nullptr) return measured;
  metrics.laps = CountLaps(truth->path, truth->outline_m);
  metrics.collisions = truth->collisions;
  metrics.obstacle_gap_m = truth->obstacle_gap_m;
  metrics.obstacle_stop_s = truth->obstacle_stop_s;
  faults.Try([&] { Compare(outcome, *truth, measured); });
  return measured;
}

}  // namespace merlin
