#include "tools/physics/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

#include "robot/description/description.h"
#include "scenarios/config/names.h"
#include "sim/world/world.h"

namespace merlin {
namespace {

constexpr char kRoom[] = "room_7x10";
constexpr double kBenchSpeed_m_s = 0.5, kBenchSteering_rad = 0.2;

// Drives back and forth on an arc, so that the wheels roll, steer and brake, and the car hits nothing.
void Drive(sim::World& world) {
  const double side = world.Now() / std::chrono::milliseconds(800) % 2 == 0 ? 1.0 : -1.0;
  world.drive().Send(
      {.speed_m_s = side * kBenchSpeed_m_s, .steering_rad = kBenchSteering_rad, .valid_for = std::chrono::seconds(1)},
      world.Now());
}

}  // namespace

PhysicsBench BenchPhysics(const std::atomic<bool>& interrupted) {
  PhysicsBench bench;
  sim::World world({.room = RoomFile(kRoom), .car = ReadCar(CarFile("merlin"))});
  std::vector<double> rates;
  for (int run = 0; run < bench.runs && !interrupted; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    for (int step = 0; step < bench.steps; ++step) {
      Drive(world);
      world.Step();
    }
    rates.push_back(bench.steps / std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  if (rates.empty()) return bench;
  std::ranges::nth_element(rates, rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2));
  bench.steps_per_s = rates[rates.size() / 2];
  bench.times_real_time = bench.steps_per_s * Seconds(sim::World::kStep);
  return bench;
}

std::string Table(const PhysicsBench& bench) {
  return fmt::format(
      "one car in {}, steps of {:g} ms; median of {} runs of {} steps\n"
      "  {:.0f} steps/s, {:.0f} times real time (at least {:g})\n",
      kRoom, 1e3 * Seconds(sim::World::kStep), bench.runs, bench.steps, bench.steps_per_s, bench.times_real_time,
      bench.least_times_real_time);
}

std::string ToJson(const PhysicsBench& bench) {
  return nlohmann::ordered_json{{"room", kRoom},
                                {"runs", bench.runs},
                                {"steps", bench.steps},
                                {"step_s", Seconds(sim::World::kStep)},
                                {"steps_per_s", bench.steps_per_s},
                                {"times_real_time", bench.times_real_time},
                                {"least_times_real_time", bench.least_times_real_time}}
             .dump(2) +
         "\n";
}

}  // namespace merlin
