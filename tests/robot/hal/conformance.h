// The conformance suite of the hardware abstraction layer: what every plug promises, tested through the interfaces
// alone. A plug runs it by instantiating HalConformance with a factory for a car that stands at the start of a
// straight, free way of at least 6 m, a wall square ahead within the depth camera's unambiguous range.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "robot/hal/hal.h"
#include "robot/types/car.h"

namespace merlin {

// One plug under test. The pointers in robot() live as long as this.
class Rigged {
 public:
  virtual ~Rigged() = default;
  virtual Robot robot() = 0;
  virtual CarDescription car() = 0;
  virtual double wall_ahead_m() = 0;   // from base_link at the start
  virtual double start_yaw_rad() = 0;  // in the world
  virtual double compass_sigma_rad() = 0;
  // How much later threads and lines may make events; zero if time waits for the test.
  virtual Duration slack() { return Duration(0); }
  // Unplugs the drive, and plugs it in again. False if there is no plug between the calls and the car.
  virtual bool Unplug() { return false; }
  virtual void PlugIn() {}
};

struct Plug {
  const char* name;
  std::function<std::unique_ptr<Rigged>()> make;
};

class HalConformance : public ::testing::TestWithParam<Plug> {};

}  // namespace merlin
