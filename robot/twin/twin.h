// The simulated robot: joins the world and its sensors (sim) to the hardware abstraction layer (hal). The world waits
// for the stack: Clock::WaitUntil steps it. The world is copied at a frame's exposure. The frame is computed from the
// copy beside the physics, and handed out when its latency is over. The bits are the same for any number of threads.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot/hal/hal.h"
#include "sim/color/renderer.h"
#include "sim/compass.h"
#include "sim/tof/tof_camera.h"
#include "sim/world/materials.h"
#include "sim/world/world.h"

namespace merlin {

struct TwinOptions {
  struct Depth {
    DepthCameraSheet sheet;
    DepthCameraErrors errors;
    DepthSettings settings;
    sim::TofEffects effects;
    double rate_hz = 20.0;
  };
  struct Color {
    ColorCameraSheet sheet;
    double rate_hz = 10.0;
    sim::Gl gl = sim::Gl::kAuto;              // not kOff
    std::optional<ColorSettings> settings{};  // none: the sheet's, automatic
    bool motion_blur = false;
  };
  struct Compass {
    sim::CompassConfig config;
    double rate_hz = 10.0;
  };

  sim::WorldOptions world;  // its materials and seed are ignored; those below are used
  sim::Materials materials;
  std::uint64_t seed = 1;
  Depth depth;
  std::optional<Color> color;
  std::optional<Compass> compass;
  double drive_rate_hz = 50.0;
  Time end{0};  // WaitUntil returns false from here on
  // 1: everything runs on the caller's thread. 2: the cameras share a second thread. 3 or more: each camera has its
  // own. 0: one thread for each camera besides the caller's. From 2 on, one more thread shares the work of a depth frame
  // that is large, or the only picture. The bits are the same for any number.
  int threads = 0;
};

// For each body, whether it belongs to the car. The car's own cameras do not see these.
std::vector<bool> CarBodies(const sim::World& world);

class Twin {
 public:
  // Throws InputError (room, car, start, settings) and MachineError (no GL).
  explicit Twin(const TwinOptions& options);
  ~Twin();
  Twin(const Twin&) = delete;
  Twin& operator=(const Twin&) = delete;

  Robot robot();
  sim::World& world();
  const sim::World& world() const;
  const std::string& gl_name() const;  // empty without colour

  // Called after every physics step, before sensors sample.
  void OnStep(std::function<void(sim::World&)> callback);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin
