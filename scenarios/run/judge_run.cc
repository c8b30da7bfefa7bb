#include "scenarios/run/judge_run.h"

#include <algorithm>
#include <span>

#include "scenarios/judge/alignment.h"
#include "scenarios/judge/laps.h"
#include "scenarios/judge/map_picture.h"
#include "scenarios/judge/map_size.h"
#include "scenarios/judge/map_truth.h"
#include "scenarios/judge/writers.h"
#include "scenarios/run/versions.h"
#include "sim/rays/ray_scene.h"

namespace merlin {
namespace {

std::vector<MapPoint> MapPoints(const Slam& slam, int points_min) {
  std::vector<MapPoint> points;
  const VoxelMap map = slam.BuildMap();
  for (const Voxel& voxel : map.voxels()) {
    if (voxel.count < points_min) continue;
    MapPoint point{.p_map = voxel.mean};
    if (voxel.has_color())
      for (int c = 0; c < 3; ++c) point.rgb[c] = static_cast<std::uint8_t>(voxel.bgr()[2 - c] + 0.5);
    points.push_back(point);
  }
  return points;
}

GridMap ToGridMap(const OccupancyGrid& grid) {
  if (grid.width() == 0) return {1, 1, grid.cell_m(), {0.0, 0.0}, {-1}};  // nothing seen: one unknown cell, still a map
  GridMap map{grid.width(), grid.height(), grid.cell_m(), grid.origin_m(), {}};
  for (int row = 0; row < grid.height(); ++row)
    for (int column = 0; column < grid.width(); ++column)
      map.cells.push_back(static_cast<std::int8_t>(grid.At(column, row)));
  return map;
}

Trajectory ToTrajectory(const std::vector<MapPose>& poses) {
  Trajectory trajectory;
  for (const MapPose& pose : poses) trajectory.push_back({pose.stamp, pose.T_map_base});
  return trajectory;
}

TrueRange TrueRangeOf(const sim::RayScene& scene) {
  return [&scene](const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world) -> double {
    const sim::Ray ray{.origin = origin_world.cast<float>(), .direction = direction_world.cast<float>()};
    sim::RayHit hit;
    scene.Cast(std::span(&ray, 1), std::span(&hit, 1));
    return hit.range_m < 0.0f ? HUGE_VAL : hit.range_m;
  };
}

StackTimes Percentiles(std::vector<double> ms) {
  if (ms.empty()) return {};
  std::ranges::sort(ms);
  const auto at = [&ms](double share) {
    return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
  };
  return {at(0.5), at(0.99), ms.back()};
}

std::string HashOf(const std::string& bytes) {
  Sha256 hash;
  hash.Add(bytes);
  return hash.Hex();
}

}  // namespace

void Evidence::Add(const DepthFrame& frame) {
  ++depth_frames;
  depth.Add(frame.stamp.count());
  depth.Add(std::span<const float>(frame.range_m));
  depth.Add(std::span<const float>(frame.amplitude));
  depth.Add(std::span<const std::uint8_t>(frame.intensity));
  depth.Add(std::span<const std::uint8_t>(frame.flags));
}

void Evidence::Add(const ColorFrame& frame) {
  ++color_frames;
  color.Add(frame.stamp.count());
  color.Add(std::span<const std::uint8_t>(frame.bgr));
}

namespace {

// The figures that need the path and the map against the truth, and the picture of both.
void Measure(const Trajectory& true_path, const Trajectory& estimate, const Trajectory& online, const sim::World* world,
             Metrics& metrics, MapPicture& picture) {
  const std::vector<PosePair> pairs = PairAtEqualStamps(true_path, estimate);
  if (const auto rpe = RpeOverOneMetre(pairs)) {
    metrics.rpe_translation_percent = rpe->translation_percent;
    metrics.rpe_rotation_deg_per_m = rpe->rotation_deg_per_m;
  }
  const auto ate = AlignAndAte(pairs);
  if (!ate) return;
  metrics.ate_rmse_m = picture.ate_rmse_m = ate->rmse_m;
  if (const auto driven = AlignAndAte(PairAtEqualStamps(true_path, online))) metrics.ate_online_rmse_m = driven->rmse_m;
  picture.T_world_map = ate->T_world_map;
  picture.size = MeasureMapSize(picture.map, ate->T_world_map, picture.outline);
  metrics.map_size_m = picture.size.size_m;
  metrics.map_size_error_percent = picture.size.error_percent;
  const sim::RayScene room(world->model(), CarBodies(*world));
  const TrueRange true_range = TrueRangeOf(room);
  metrics.map_to_plan_p95_m = MapToPlanP95_m(picture.map, ate->T_world_map, true_range);
  metrics.coverage_percent = CoveragePercent(picture.map, ate->T_world_map, picture.outline, true_path, true_range);
}

}  // namespace

RunResult JudgeRun(const std::string& name, const Scenario& scenario, const Robot& robot, const TrueWorld& true_world,
                   const DriveLoop& loop, const Evidence& evidence, const OutputFolder& folder, FirstFault& faults) {
  RunResult result{.scenario = name, .seed = scenario.seed, .versions = Versions()};
  Metrics& metrics = result.metrics;
  const Slam& slam = loop.slam();
  const Truth* truth = true_world.truth;
  const Outline outline = true_world.world != nullptr ? true_world.world->plan_xy_m() : Outline{};
  const Trajectory true_path = truth != nullptr ? truth->trajectory() : Trajectory{};
  const Trajectory estimate = ToTrajectory(slam.trajectory()), online = ToTrajectory(slam.online());

  metrics.distance_m = truth != nullptr ? PathLength_m(true_path) : slam.path_m();
  if (truth != nullptr) {
    metrics.laps = CountLaps(true_path, outline);
    metrics.collisions = truth->collisions();
    metrics.obstacle_gap_m = truth->obstacle_gap_m();
    metrics.obstacle_stop_s = truth->obstacle_stop_s();
  }
  metrics.loops_closed = slam.loops();
  metrics.depth_frames = evidence.depth_frames;
  metrics.color_frames = evidence.color_frames;
  metrics.stack_ms = Percentiles(loop.stack_ms());
  faults.Try([&] {
    metrics.frames_dropped =
        static_cast<std::int64_t>(robot.depth->Status().missed + (robot.color ? robot.color->Status().missed : 0));
  });

  // Writes a file; gives the hash of what was written.
  const auto write = [&](const char* file, const auto& bytes) {
    std::optional<std::string> hash;
    faults.Try([&] {
      const std::string made = bytes();
      folder.Write(file, made);
      hash = HashOf(made);
    });
    return hash;
  };
  const auto trajectory_hash = write("trajectory_estimate.tum", [&] { return ToTum(estimate); });
  write("trajectory_online.tum", [&] { return ToTum(online); });
  if (truth != nullptr) write("trajectory_truth.tum", [&] { return ToTum(true_path); });

  std::vector<MapPoint> map;
  faults.Try([&] { map = MapPoints(slam, scenario.slam.map_points_min); });
  const auto map_hash = write("map.ply", [&] { return ToPly(map); });
  const GridMap grid = ToGridMap(slam.BuildOccupancy());
  if (write("map.pgm", [&] { return ToPgm(grid); })) write("map.yaml", [&] { return ToMapYaml(grid, "map.pgm"); });

  MapPicture picture{.title = name + ", seed " + std::to_string(scenario.seed),
                     .map = map,
                     .outline = outline,
                     .truth = true_path,
                     .estimate = estimate};
  faults.Try([&] { Measure(true_path, estimate, online, true_world.world, metrics, picture); });
  write("map.png", [&] { return ToPng(picture); });

  if (!true_world.repeats) return result;
  result.hashes = {.state = truth->state_hash(),
                   .depth = evidence.depth.Hex(),
                   .color = std::nullopt,
                   .trajectory = trajectory_hash,
                   .map = map_hash};
  if (robot.color) result.hashes.color = evidence.color.Hex();
  return result;
}

}  // namespace merlin
