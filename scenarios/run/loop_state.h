// One tick of the main loop as plain data: the measurements received, the stack's results, the decision and the command
// sent. Recorder, operator station, progress and tests read only this. A copy is cheap and never changes: it shares
// frames and observation, which are constant.
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
  Time began{0};  // when the loop began; on a real car the clock starts earlier, for the checks

  // Measurements that arrived in this tick, in order of stamps.
  struct Heard {
    std::vector<DriveState> drive;
    std::vector<CompassReading> compass;
    std::vector<PanState> pan, turntable;
    std::vector<std::shared_ptr<const DepthFrame>> depth;  // as delivered, unfiltered
    std::vector<std::shared_ptr<const ColorFrame>> color;
  } heard{};
  std::vector<SupervisedDevice> devices{};  // every device of the robot, in the same order at every tick
  std::string stop{};                       // why the car must stop, as a sentence; empty: it may drive
  std::vector<Outage> outages{};            // outages so far of devices that the run can do without

  // The newest state of each kind, from this tick or an earlier one.
  DriveState drive{};
  double speed_m_s = 0.0;  // from the encoder; negative: backwards
  EnergyLevel energy = EnergyLevel::kEnough;
  std::shared_ptr<const Observation> observation{};  // null before the first
  std::optional<Pose> T_map_base{};                  // at that observation; none before mapping begins
  double path_m = 0.0;                               // length of the path in the map so far
  int loops = 0;                                     // loops closed so far

  // Decision and command.
  std::optional<Decision> decision{};  // newest decision of the pilot
  Time decided{0};                     // when it was made; equals now if in this tick
  ManualCommand manual{};              // of the operator; without an operator: not steering, autonomy enabled
  Arbitration arbitration{};           // the command that was sent, and who gave it
};

// What the car is doing, for display: "follows the corridor", or who drives instead ("manual", "nobody", ...).
inline std::string Doing(const LoopState& state) {
  return state.arbitration.driver == Driver::kAutonomy ? state.decision->doing : Name(state.arbitration.driver);
}

}  // namespace merlin
