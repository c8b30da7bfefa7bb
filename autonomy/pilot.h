// The pilot: asks the behaviour what to do next, and drives it safely. It knows no plan of the room, only what the sensors
// gave.
//
//   Situation -> gates -> behaviour -> Intent -> pursuit -> obstacles or free ground -> Decision
//
// The gates: without a pose the behaviour is not asked; without a map, while the car is lost, or when the task is done,
// the car stands. It does not stand for good: see unstick.h.
// Forwards the pilot drives as fast as the depth camera shows free distance ahead (avoid.h); backwards slowly, and only
// over ground that the map knows to be free (free_ground.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "autonomy/arbitrate.h"
#include "autonomy/avoid.h"
#include "autonomy/behaviors/table.h"
#include "autonomy/energy.h"
#include "autonomy/free_ground.h"
#include "autonomy/look_around.h"
#include "autonomy/pursue.h"
#include "autonomy/situation.h"
#include "autonomy/task.h"
#include "autonomy/unstick.h"
#include "robot/types/measurements.h"

namespace merlin {

struct PilotConfig {
  BehaviorConfig behavior{};
  double look_ahead_m = 0.9;     // [0.2, 5] of pure pursuit; longer is smoother, shorter follows the path more closely
  double command_valid_s = 0.3;  // [0.02, 5] the car brakes by itself when no command follows
  int lost_frames_max = 20;  // [1, 1000] frames in a row that do not fit the map; then the car stands until one fits
  double search_speed_m_s = 0.3;  // [0.05, 2] at most, while the car searches for its place in a loaded map
  AvoidConfig avoid{};
  BackConfig back{};
  UnstickConfig unstick{};
  LookAroundConfig look_around{};
  EnergyConfig energy{};
  ArbitrateConfig arbitrate{};
};

template <class Visitor>
void Visit(Visitor& v, PilotConfig& c) {
  Visit(v, c.behavior);  // the keys of the behaviours stand directly below `pilot`
  v("look_ahead_m", c.look_ahead_m, {0.2, 5.0});
  v("command_valid_s", c.command_valid_s, {0.02, 5.0});
  v("lost_frames_max", c.lost_frames_max, {1.0, 1000.0});
  v("search_speed_m_s", c.search_speed_m_s, {0.05, 2.0});
  v("avoid", c.avoid);
  v("back", c.back);
  v("unstick", c.unstick);
  v("look_around", c.look_around);
  v("energy", c.energy);
  v("arbitrate", c.arbitrate);
}

struct Decision {
  DriveCommand command;  // steering: of the wheels
  bool done = false;     // the task is finished; the command is to stand
  Activity activity = Activity::kIsDone;
  std::string doing;                      // the same for people: "follows the corridor", "waits for an obstacle", ...
  std::string gives_up{};                 // not empty: why the run should end, since the car does not get on
  std::optional<double> turntable_rad{};  // where the turntable is to turn, from its start; none: nothing new
  std::optional<double> pan_rad{};        // where the cameras are to look, positive to the left; none: nothing new
};

class Pilot {
 public:
  // The behaviour of the task's name; there must be one.
  Pilot(const CarDescription& car, const Task& task, const PilotConfig& config);
  Pilot(const CarDescription& car, Behavior behavior, const PilotConfig& config);

  // One decision per depth frame.
  Decision Decide(const Situation& situation);

 private:
  Decision DecideUnstuck(const Situation& situation);
  Decision DecideByTask(const Situation& situation);
  Decision Halt(Activity activity) const;
  Decision Drive(const Situation& situation, const Intent& intent);
  double SpeedLimit_m_s(const Situation& situation, const Pursuit& pursuit, Direction direction);
  DriveCommand Command(double speed_m_s, double steering_rad) const;

  CarDescription car_;
  Footprint footprint_;
  Behavior behavior_;
  PilotConfig config_;
  Avoid avoid_;
  Unstick unstick_;
  LookAround look_around_;
  std::optional<double> free_m_;       // ahead, as far as known at the newest decision
  std::optional<PathAcross> look_at_;  // of the newest path forwards
};

}  // namespace merlin
