#include "tools/slam/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <variant>

#include "perception/pipeline.h"
#include "robot/twin/twin.h"
#include "scenarios/config/names.h"
#include "scenarios/run/drive_loop.h"
#include "scenarios/run/twin_options.h"
#include "slam/slam.h"

namespace merlin {
namespace {

constexpr char kScenario[] = "corridor_short", kLap[] = "corridor_loop";
constexpr double kSpeed_m_s = 0.5;
constexpr double kDrive_s = 16.0;
constexpr double kHalfWidth_m = 1.05, kHeight_m = 2.5, kEnd_m = 6.5;  // of the synthetic corridor
const Eigen::Vector3d kCamera_base(0.3, 0.0, 0.35);

// The measurements from which a row is made.
struct Times {
  std::vector<double> ms;
  std::vector<int> points;

  void Add(double taken_ms) { ms.push_back(taken_ms); }

  template <class Work>
  void Add(int count, const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    points.push_back(count);
  }
};

template <class Value>
Value Quantile(std::vector<Value> values, double share) {
  if (values.empty()) return Value{};
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

// A limit on the result; 0: none.
struct Limits {
  double median_ms = 0.0, p99_ms = 0.0, max_ms = 0.0;
};

SlamBench::Row RowOf(const std::string& what, const Times& times, const Limits& limits) {
  return {.what = what,
          .points = Quantile(times.points, 0.5),
          .median_ms = Quantile(times.ms, 0.5),
          .p99_ms = Quantile(times.ms, 0.99),
          .max_ms = Quantile(times.ms, 1.0),
          .median_limit_ms = limits.median_ms,
          .p99_limit_ms = limits.p99_ms,
          .max_limit_ms = limits.max_ms};
}

// How far a ray goes in a corridor along x, with an end wall.
double Range_m(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double range_m = HUGE_VAL;
  const auto meet = [&](int axis, double plane_m) {
    const double t = (plane_m - from(axis)) / along(axis);
    if (t > 0.0) range_m = std::min(range_m, t);
  };
  meet(0, kEnd_m);
  meet(1, kHalfWidth_m);
  meet(1, -kHalfWidth_m);
  meet(2, 0.0);
  meet(2, kHeight_m);
  return range_m;
}

// All 64 x 48 pixels of a camera on the car, with noise along the rays.
std::vector<Point> View(const Pose& T_map_base, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  std::vector<Point> points_base;
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const Eigen::Vector3d ray = Eigen::Vector3d(1.0, (31.5 - u) / 60.0, (23.5 - v) / 60.0).normalized();
      const double range_m = Range_m(T_map_base * kCamera_base, T_map_base.linear() * ray);
      const double sigma_m = 0.004 + 0.002 * range_m;
      points_base.push_back({.position = (kCamera_base + (range_m + sigma_m * noise(random)) * ray).cast<float>(),
                             .sigma_m = static_cast<float>(sigma_m)});
    }
  return points_base;
}

// A guess that is a little wrong, with the uncertainty that odometry and compass have.
PosePrior Guess(const Pose& T_map_base, int round) {
  PosePrior prior;
  prior.T_map_base =
      T_map_base * FromXyYaw(0.01 * std::cos(3.0 * round), 0.01 * std::sin(2.0 * round), 0.004 * std::sin(5.0 * round));
  Vector6d sigma;
  sigma << 0.003, 0.003, 0.002, 0.001, 0.001, 0.004;
  prior.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return prior;
}

void BenchRegistration(SlamBench& bench, const std::atomic<bool>& interrupted) {
  const SlamConfig config;
  VoxelMap map(config.local);
  for (int i = 0; i < 12; ++i) {
    const Pose T_map_base = FromXyYaw(-1.0 + 0.1 * i, 0.05 * std::sin(i), 0.05 * std::cos(i));
    map.Insert(View(T_map_base, static_cast<std::uint32_t>(i)), T_map_base, 0.1 * i);
  }
  Times whole, thinned;
  for (int round = 0; round < bench.rounds && !interrupted; ++round) {
    const Pose T_map_base = FromXyYaw(0.15 + 0.0002 * round, 0.02 * std::cos(round), 0.03 * std::sin(round));
    const std::vector<Point> points = View(T_map_base, static_cast<std::uint32_t>(100 + round));
    const std::vector<Point> thin = Downsample(points, config.source_voxel_m);
    const PosePrior prior = Guess(T_map_base, round);
    for (const auto& [times, source] : {std::pair(&whole, &points), std::pair(&thinned, &thin)})
      times->Add(static_cast<int>(source->size()),
                 [&] { (void)Register(*source, kCamera_base.cast<float>(), map, prior, config.icp); });
  }
  bench.rows.push_back(RowOf("registration, every point", whole, {.median_ms = 2.0}));
  bench.rows.push_back(RowOf(fmt::format("registration, thinned to {:g} m", config.source_voxel_m), thinned, {}));
}

// Everything that the devices of a twin deliver on a straight drive, in order of arrival.
using Measurement = std::variant<DriveState, CompassReading, DepthFrame>;

std::vector<Measurement> RecordDrive(Twin& twin, const std::atomic<bool>& interrupted) {
  const Robot robot = twin.robot();
  const Duration tick = FromSeconds(1.0 / robot.depth->Info().rate_hz);
  std::vector<Measurement> measurements;
  while (!interrupted && robot.clock->WaitUntil(robot.clock->Now() + tick)) {
    robot.drive->Send({.speed_m_s = kSpeed_m_s, .steering_rad = 0.0, .valid_for = std::chrono::seconds(1)});
    while (auto state = robot.drive->Poll()) measurements.emplace_back(*state);
    while (auto reading = robot.compass->Poll()) measurements.emplace_back(*reading);
    while (auto frame = robot.depth->Poll()) measurements.emplace_back(std::move(*frame));
  }
  return measurements;
}

void BenchFrames(SlamBench& bench, const std::atomic<bool>& interrupted) {
  RunOptions options{.name = kScenario, .scenario = ReadScenario(kScenario, {}), .out = {}, .progress = {}};
  options.scenario.sensors.color.reset();
  options.scenario.duration_s = kDrive_s;
  Twin twin(TwinOptionsOf(options.scenario, options));
  const DepthCameraInfo& camera = twin.robot().depth->Info();
  Pipeline pipeline(
      {BelievedCar(options.scenario.car), camera.sheet, camera.T_base_camera, std::nullopt, Pose::Identity()},
      options.scenario.perception);
  Slam slam(options.scenario.slam);
  Times times;
  int lost = 0;
  for (Measurement& measurement : RecordDrive(twin, interrupted)) {
    if (const auto* state = std::get_if<DriveState>(&measurement)) pipeline.Add(*state);
    if (const auto* reading = std::get_if<CompassReading>(&measurement)) pipeline.Add(*reading);
    auto* frame = std::get_if<DepthFrame>(&measurement);
    if (frame == nullptr) continue;
    std::optional<Observation> observation;
    std::optional<Pose> T_map_base;
    times.Add(0, [&] {
      observation = pipeline.Process(std::move(*frame));
      if (observation) T_map_base = slam.Update(*observation);
    });
    times.points.back() = observation ? static_cast<int>(observation->points_base.size()) : 0;
    if (!T_map_base) times.ms.pop_back(), times.points.pop_back();  // the heading settles: no pose yet
    lost += T_map_base && slam.lost_frames() > 0 ? 1 : 0;
  }
  bench.frames = static_cast<int>(times.ms.size());
  bench.not_converged = bench.frames > 0 ? static_cast<double>(lost) / bench.frames : 0.0;
  bench.rows.push_back(RowOf("frame, filter to pose", times, {.median_ms = 2.0, .p99_ms = 5.0}));
}

// A whole lap without colour. Its last metres are mapped already, so that loops are closed.
void BenchLap(SlamBench& bench, const std::atomic<bool>& interrupted) {
  // One thread: a simulated camera beside the loop would take the cores that the frames are timed on.
  RunOptions options{.name = kLap, .scenario = ReadScenario(kLap, {}), .out = {}, .threads = 1, .progress = {}};
  const Scenario& scenario = options.scenario;
  options.scenario.sensors.color.reset();
  Twin twin(TwinOptionsOf(scenario, options));
  DriveLoop loop(twin.robot(), BelievedCar(scenario.car), scenario.perception, scenario.slam, scenario.task,
                 scenario.pilot);
  Times frames, closing;
  const auto watch = [&](const LoopState& state) {
    if (state.decided != state.now) return true;
    frames.Add(loop.stack_ms().back());
    if (state.loops > bench.loops) closing.Add(loop.stack_ms().back());
    bench.loops = state.loops;
    return true;
  };
  loop.Run(interrupted, watch);
  bench.rows.push_back(RowOf("lap, every frame", frames, {.median_ms = 2.0, .p99_ms = 5.0, .max_ms = 50.0}));
  bench.rows.push_back(RowOf("lap, frames that close a loop", closing, {.max_ms = 50.0}));
}

std::string Limit(double limit_ms) { return limit_ms > 0.0 ? fmt::format("({:g})", limit_ms) : ""; }

}  // namespace

SlamBench BenchSlam(const std::atomic<bool>& interrupted) {
  SlamBench bench;
  BenchRegistration(bench, interrupted);
  BenchFrames(bench, interrupted);
  BenchLap(bench, interrupted);
  return bench;
}

std::string Table(const SlamBench& bench) {
  std::string text = fmt::format(
      "one thread; registration in a corridor with an end wall, {} times; {} frames of a drive in {} ({:.1f} % not "
      "registered); a lap of {}, filter to command, {} loops closed\n  {:<36} {:>7} {:>16} {:>16} {:>16}\n",
      bench.rounds, bench.frames, kScenario, 100.0 * bench.not_converged, kLap, bench.loops, "ms (at most)", "points",
      "median", "p99", "max");
  for (const SlamBench::Row& row : bench.rows)
    text += fmt::format("  {:<36} {:>7} {:>9.2f} {:>6} {:>9.2f} {:>6} {:>9.2f} {:>6}\n", row.what,
                        row.points > 0 ? fmt::format("{}", row.points) : "", row.median_ms, Limit(row.median_limit_ms),
                        row.p99_ms, Limit(row.p99_limit_ms), row.max_ms, Limit(row.max_limit_ms));
  return text;
}

std::string ToJson(const SlamBench& bench) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const auto limit = [](double limit_ms) {
    return limit_ms > 0.0 ? nlohmann::ordered_json(limit_ms) : nlohmann::ordered_json();
  };
  for (const SlamBench::Row& row : bench.rows)
    rows.push_back({{"what", row.what},
                    {"points", row.points},
                    {"median_ms", row.median_ms},
                    {"p99_ms", row.p99_ms},
                    {"max_ms", row.max_ms},
                    {"median_limit_ms", limit(row.median_limit_ms)},
                    {"p99_limit_ms", limit(row.p99_limit_ms)},
                    {"max_limit_ms", limit(row.max_limit_ms)}});
  return nlohmann::ordered_json{{"scenario", kScenario},
                                {"rounds", bench.rounds},
                                {"frames", bench.frames},
                                {"not_converged_share", bench.not_converged},
                                {"lap", kLap},
                                {"loops", bench.loops},
                                {"rows", rows}}
             .dump(2) +
         "\n";
}

}  // namespace merlin
