// A scenario: what is run and how it is judged. Read from a file, with all defaults filled in.
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
  DrivetrainConfig drivetrain;  // for the twin only: how the true car differs from its model
  bool pan = false;  // whether the pan unit (pan_joint of the model) moves; false: it is held ahead. With a narrow
                     // lens it sweeps by itself (autonomy/look_around.h)
  std::string calibration;  // file of `merlin calibrate odometry` that the stack uses; empty: the values of the model
};

template <class Visitor>
void Visit(Visitor& v, CarChoice& c) {
  v("model", c.model);
  v("start", c.start);
  v("drivetrain", c.drivetrain);
  v("pan", c.pan);
  v("calibration", c.calibration);
}

// Integration time of one sub-frame. None (`auto` in the file): the stack chooses it for each frame.
struct IntegrationTime {
  std::optional<double> us;
};

struct DepthSensor {
  std::string camera = "pmd_3k_s";  // models/cameras/<name>.yaml, or a path
  double rate_hz = 20.0;            // also the rate of the stack; at most that of the data sheet
  std::string effects = "all";      // all, raw, ideal, or names
  IntegrationTime integration_us;   // auto or a number; the data sheet has the valid range
  double frequency_mhz = 20.0;
  double second_frequency_mhz = 0.0;  // 0: none; else eight sub-frames and a larger unambiguous range
  bool post_processing = false;       // of the manufacturer: masks low amplitudes, 3x3 median
  std::optional<double> latency_s;    // default: that of the data sheet
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
  bool required = true;               // without GL: true refuses to start, false runs without colour
  std::optional<double> exposure_us;  // fixed, with gain 1; default: automatic; the data sheet has the valid range
  bool motion_blur = false;           // mean of eight pictures per frame, which takes eight times as long
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
  std::vector<Steel> steel;   // for the twin only: steel that distorts the magnetic field
};

template <class Visitor>
void Visit(Visitor& v, CompassSensor& c) {
  v("rate_hz", c.rate_hz, {0.1, 500.0});
  v("noise_rad", c.noise_rad, {0.0, 0.2});
  v("steel", c.steel);
}

struct Sensors {
  DepthSensor depth;
  std::optional<ColorSensor> color;  // none if the scenario does not list it
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
  double duration_s = 60.0;  // longest time; the run ends earlier when the task is done
  std::uint64_t seed = 1;
  Sensors sensors;
  Task task;
  std::string map;  // map.slam of an earlier run: the car starts in it, and searches for its place; empty: a new map
  std::vector<sim::ObstacleConfig> obstacles;  // for the twin only, like actors
  std::vector<sim::ActorConfig> actors;
  std::vector<CheckLimit> checks;
  PerceptionConfig perception;
  SlamConfig slam;
  PilotConfig pilot;
  std::vector<std::string> warnings;  // one sentence each for the author of the file; not a key
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

// name: a file in scenarios/ without its extension, or a path. Paths in the file are relative to its folder. overrides:
// settings "a.b=c" that replace those of the file. Throws InputError for an unknown scenario or key (and suggests the
// nearest), broken YAML (with file and line), a value of the wrong kind or out of range, and an unknown check or
// behavior. It lists all faults at once, one per line.
Scenario ReadScenario(const std::string& name, const std::vector<std::string>& overrides);

// The scenario with every default written out; reading it gives the same scenario.
std::string ToYaml(const Scenario& scenario);

}  // namespace merlin
