// MERLIN before a wall, as the plugs that have the twin behind them run the conformance suite.
#pragma once

#include <filesystem>

#include "robot/description/description.h"
#include "robot/twin/twin.h"
#include "tests/robot/hal/conformance.h"
#include "tests/sim/world/car_world.h"

namespace merlin {

constexpr char kRoomWithWall[] = R"(<geom name="floor" type="plane" size="20 20 1"/>
  <geom name="wall" type="box" size="0.1 5 2" pos="7.1 0 2"/>)";

// The car at the room's origin, looking along x, with depth camera, compass and pan unit.
inline TwinOptions MerlinIn(const sim::TemporaryFile& room) {
  TwinOptions options;
  options.world.room = room.path();
  options.world.car = sim::Merlin();
  options.world.car.pan->moves = true;
  options.depth.sheet = ReadDepthCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
  options.compass = TwinOptions::Compass{};
  return options;
}

// What every plug with this car and room answers.
class MerlinBeforeWall : public Rigged {
 public:
  CarDescription car() override { return sim::Merlin(); }
  double wall_ahead_m() override { return 7.0; }
  double start_yaw_rad() override { return 0.0; }
  double compass_sigma_rad() override { return sim::CompassConfig{}.yaw_noise_rad; }

 protected:
  const sim::TemporaryFile room_{"room.xml", sim::Room(kRoomWithWall)};
};

}  // namespace merlin
