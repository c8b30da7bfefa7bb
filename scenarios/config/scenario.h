// What is run and how it is judged: a scenario file, resolved.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/pilot.h"
#include "perception/pipeline.h"
#include "robot/base/config.h"
#include "robot/types/drivetrain_config.h"
#include "robot/types/steel.h"
#include "scenarios/judge/result.h"
#include "sim/actors/actor_config.h"
#include "slam/slam.h"

namespace merlin {

struct CarStart {
  double x_m = 0.0;  // base_link in the room's frame
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

template <class Visitor>
void Visit(Visitor& v, CarStart& c) {
  v("x_m", c.x_m, {-1e4, 1e4});
  v("y_m", c.y_m, {-1e4, 1e4});
  v("yaw_rad", c.yaw_rad, {-6.3, 6.3});
}

struct CarChoice {
  std::string model = "merlin";  // models/<name>/<name>.urdf, or a path
  CarStart start;
  DrivetrainConfig drivetrain;  // of the twin: how the true car differs from its model
  bool pan = false;         // the unit that turns the cameras moves (pan_joint of the model); false: it is held ahead.
                            // It sweeps by itself where the lens is narrow (autonomy/look_around.h)
  std::string calibration;  // what the stack believes: a file of `merlin calibrate odometry`; empty: the model
};

template <class Visitor>
void Visit(Visitor& v, CarChoice& c) {
  v("model", c.model);
  v("start", c.start);
  v("drivetrain", c.drivetrain);
  v("pan", c.pan);
  v("calibration", c.calibration);
}

// Of one sub-frame. Nothing (`auto` in the file): the stack chooses it, frame by frame.
struct IntegrationTime {
  std::optional<double> us;
};

struct DepthSensor {
  std::string camera = "pmd_3k_s";  // models/cameras/<name>.yaml, or a path
  double rate_hz = 20.0;            // of the stack too; up to the sheet's
  std::string effects = "all";      // all, raw, ideal, or names
  IntegrationTime integration_us;   // auto, or a number; valid ones: the camera's sheet
  double frequency_mhz = 20.0;
  double second_frequency_mhz = 0.0;  // 0: none; another valid one: eight sub-frames, and a range that wraps later
  bool post_processing = false;       // the maker's own: low amplitudes masked, 3x3 median
  std::optional<double> latency_s;    // default: the sheet's
};

template <class Visitor>
void Visit(Visitor& v, DepthSensor& c) {
  v("camera", c.camera);
  v("rate_hz", c.rate_hz, {5.0, 500.0});
  v("effects", c.effects);
  v("integration_us", c.integration_us);
  v("frequency_mhz", c.frequency_mhz, {0.1, 1000.0});
  v("second_frequency_mhz", c.second_frequency_mhz, {0.0, 1000.0});
  v("post_processing", c.post_processing);
  v("latency_s", c.latency_s, {0.0, 0.5});
}

struct ColorSensor {
  std::string camera = "ccd";
  double rate_hz = 10.0;
  bool required = true;               // without GL: stop before it starts (true), or run without colour (false)
  std::optional<double> exposure_us;  // fixed, at gain 1; default: automatic. Valid ones: the camera's sheet
  bool motion_blur = false;           // eight pictures a frame, each at the cost of one
  std::optional<double> latency_s;
};

template <class Visitor>
void Visit(Visitor& v, ColorSensor& c) {
  v("camera", c.camera);
  v("rate_hz", c.rate_hz, {0.1, 500.0});
  v("required", c.required);
  v("exposure_us", c.exposure_us, {1.0, 1e7});
  v("motion_blur", c.motion_blur);
  v("latency_s", c.latency_s, {0.0, 0.5});
}

struct CompassSensor {
  double rate_hz = 10.0;
  double noise_rad = 0.0087;  // one sigma of each angle; 0.5 deg (data sheets: 0.3-1 deg)
  std::vector<Steel> steel;   // of the twin: what bends its field
};

template <class Visitor>
void Visit(Visitor& v, CompassSensor& c) {
  v("rate_hz", c.rate_hz, {0.1, 500.0});
  v("noise_rad", c.noise_rad, {0.0, 0.2});
  v("steel", c.steel);
}

struct Sensors {
  DepthSensor depth;
  std::optional<ColorSensor> color;  // not listed: the robot has none
  std::optional<CompassSensor> compass;
};

template <class Visitor>
void Visit(Visitor& v, Sensors& c) {
  v("depth", c.depth);
  v("color", c.color);
  v("compass", c.compass);
}

struct Scenario {
  std::string room;              // models/rooms/<name>.xml, or a path
  std::string curtain = "open";  // open or closed; closed needs a room with a curtain
  CarChoice car;
  double duration_s = 60.0;  // the run ends here at the latest; earlier when the task is done
  std::uint64_t seed = 1;
  Sensors sensors;
  Task task;
  std::string map;  // map.slam of an earlier run: the car starts in it, and searches for its place; empty: a new map
  std::vector<sim::ObstacleConfig> obstacles;  // of the twin, as actors
  std::vector<sim::ActorConfig> actors;
  std::vector<CheckLimit> checks;
  PerceptionConfig perception;
  SlamConfig slam;
  PilotConfig pilot;
  std::vector<std::string> warnings;  // one sentence each, of what the file's author should know; not in the file
};

template <class Visitor>
void Visit(Visitor& v, Scenario& c) {
  v("room", c.room);
  v("curtain", c.curtain);
  v("car", c.car);
  v("duration_s", c.duration_s, {0.1, 1e5});
  v("seed", c.seed);
  v("sensors", c.sensors);
  v("task", c.task);
  v("map", c.map);
  v("obstacles", c.obstacles);
  v("actors", c.actors);
  v("checks", c.checks);
  v("perception", c.perception);
  v("slam", c.slam);
  v("pilot", c.pilot);
}

// name: of a file in scenarios/ without its ending, or a path; paths in it are relative to its own folder. overrides: "a.b=c" each, applied over the file.
// Throws InputError: unknown scenario or key (names the nearest), broken YAML (file and line), a value of the wrong kind or
// out of its range, an unknown check or behavior: all faults at once, a line each.
Scenario ReadScenario(const std::string& name, const std::vector<std::string>& overrides);

// The scenario with every default written out; reading it gives the same scenario.
std::string ToYaml(const Scenario& scenario);

}  // namespace merlin
