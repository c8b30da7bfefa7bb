// One tick of the main loop as plain data: what was heard, what the stack made of it, what was decided and sent. Recorder,
// operator station, progress and tests read this and nothing live. A copy is cheap, and stays as it is: frames and
// observation are shared and never change.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/arbitrate.h"
#include "autonomy/energy.h"
#include "autonomy/pilot.h"
#include "autonomy/supervise.h"
#include "perception/observation.h"
#include "robot/types/color_camera.h"
#include "robot/types/depth_camera.h"
#include "robot/types/measurements.h"

namespace merlin {

struct LoopState {
  Time now{0};
  Time began{0};  // when the loop began: on a real car the clock runs before, while the car is checked

  // What arrived in this tick, in order of stamps.
  struct Heard {
    std::vector<DriveState> drive;
    std::vector<CompassReading> compass;
    std::vector<PanState> pan, turntable;
    std::vector<std::shared_ptr<const DepthFrame>> depth;  // as delivered, unfiltered
    std::vector<std::shared_ptr<const ColorFrame>> color;
  } heard{};
  std::vector<SupervisedDevice> devices{};  // every device of the robot, in the same order at every tick
  std::string stop{};                       // why the car must stop, one sentence; empty: drive on
  std::vector<Outage> outages{};            // so far, of the devices that the run can do without

  // What is known. Each is the newest, from this tick or an earlier one.
  DriveState drive{};
  double speed_m_s = 0.0;  // by the encoder; negative: backwards
  EnergyLevel energy = EnergyLevel::kEnough;
  std::shared_ptr<const Observation> observation{};  // null before the first
  std::optional<Pose> T_map_base{};                  // of that observation; none: mapping has not begun
  double path_m = 0.0;                               // that the car has gone, by the map
  int loops = 0;                                     // closed

  // What was decided.
  std::optional<Decision> decision{};  // the pilot's newest
  Time decided{0};                     // when it came; now: in this tick
  ManualCommand manual{};              // of the operator; without one: nobody steers, autonomy is on
  Arbitration arbitration{};           // the command that was sent, and whose it is
};

// What the car is doing, for people: "follows the corridor", or who else drives ("manual", "nobody", ...).
inline std::string Doing(const LoopState& state) {
  return state.arbitration.driver == Driver::kAutonomy ? state.decision->doing : Name(state.arbitration.driver);
}

}  // namespace merlin
