// The pilot: follows a corridor in its middle, turns where it turns, stops before what stands in the way, and stops for
// good when its laps are done. It knows no plan of the room, only what the sensors gave.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "autonomy/arbitrate.h"
#include "autonomy/avoid.h"
#include "autonomy/corridor.h"
#include "autonomy/energy.h"
#include "perception/observation.h"
#include "robot/types/measurements.h"
#include "slam/slam.h"

namespace merlin {

struct PilotConfig {
  double speed_m_s = 0.5;       // [0.05, 2] along a corridor; the thesis' indoor mapping speed
  double turn_speed_m_s = 0.4;  // [0.05, 2] around a corner
  double look_ahead_m = 0.9;    // [0.2, 5] of pure pursuit; longer is smoother, shorter truer
  double turn_radius_m = 0.9;   // [0.3, 5] of the arc around a corner; the car's smallest is 0.71
  double decide_m = 2.6;        // [0.5, 7] distance to the end wall at which it decides where to turn
  double lap_overlap_m =
      0.7;  // [0, 5] a lap ends this far beyond the line where it began: what was seen at first is seen again
  double command_valid_s = 0.3;  // [0.02, 5] the car brakes by itself when no command follows
  int lost_frames_max = 20;      // [1, 1000] frames in a row without registration, then it stands until one fits
  AvoidConfig avoid;
  CorridorConfig corridor;
  EnergyConfig energy;
  ArbitrateConfig arbitrate;
};

template <class Visitor>
void Visit(Visitor& v, PilotConfig& c) {
  v("speed_m_s", c.speed_m_s, {0.05, 2.0});
  v("turn_speed_m_s", c.turn_speed_m_s, {0.05, 2.0});
  v("look_ahead_m", c.look_ahead_m, {0.2, 5.0});
  v("turn_radius_m", c.turn_radius_m, {0.3, 5.0});
  v("decide_m", c.decide_m, {0.5, 7.0});
  v("lap_overlap_m", c.lap_overlap_m, {0.0, 5.0});
  v("command_valid_s", c.command_valid_s, {0.02, 5.0});
  v("lost_frames_max", c.lost_frames_max, {1.0, 1000.0});
  v("avoid", c.avoid);
  v("corridor", c.corridor);
  v("energy", c.energy);
  v("arbitrate", c.arbitrate);
}

struct Task {
  std::string behavior = "follow_corridor";  // or turn_on_stand: the car stands on a turntable, which turns
  int laps = 0;                              // [0, 1000] closed rounds after which it stops; 0: drive on
  double angle_deg = 360.0;                  // [-3600, 3600] that the stand turns, positive to the left
  double rate_deg_s = 20.0;                  // [0.1, 180] of the stand
};

template <class Visitor>
void Visit(Visitor& v, Task& c) {
  v("behavior", c.behavior);
  v("laps", c.laps, {0.0, 1000.0});
  v("angle_deg", c.angle_deg, {-3600.0, 3600.0});
  v("rate_deg_s", c.rate_deg_s, {0.1, 180.0});
}

inline bool IsOnStand(const Task& task) { return task.behavior == "turn_on_stand"; }

// What a task's behavior may be: the name, and one sentence of what the car does.
struct BehaviorInfo {
  std::string name, description;
};
std::vector<BehaviorInfo> Behaviors();
std::vector<std::string> BehaviorNames();

struct Decision {
  DriveCommand command;
  bool done = false;                  // the task is finished: the command is to stand
  std::string doing;                  // "follows the corridor", "turns left", "waits for an obstacle", ...
  std::optional<double> stand_rad{};  // where the stand is to turn, from its start; none: nothing new
};

class Pilot {
 public:
  Pilot(const CarDescription& car, const Task& task, const PilotConfig& config);
  // One decision a depth frame. T_map_base: of this observation, if there is one.
  Decision Decide(const Observation& observation, const std::optional<Pose>& T_map_base, const Slam& slam);
  // Somebody else has driven: what it meant to drive is old. Its laps still count.
  void Forget();

 private:
  void CountLaps(const Pose& T_map_base);
  Decision TurnOnStand(const Observation& observation);
  void FollowCorridor(const Pose& T_map_base, const Slam& slam);
  void PlanTurn(const Corridor& corridor, const Pose& T_map_base, double side);
  bool TurnIsOver(const Pose& T_map_base) const;
  DriveCommand Command(double speed_m_s, double steering_rad) const;
  // The arc of pure pursuit from the car to the path, then the path: what the car will really sweep.
  struct Pursuit {
    double steering_rad = 0.0;
    std::vector<Eigen::Vector2d> way_base;
  };
  Pursuit Pursue(const std::vector<Eigen::Vector2d>& path_base) const;

  CarDescription car_;
  Task task_;
  PilotConfig config_;
  Avoid avoid_;
  std::optional<Pose> T_map_start_;
  double last_yaw_rad_ = 0.0, turned_rad_ = 0.0;  // since the start, unwrapped
  int laps_ = 0;
  std::optional<double> stand_yaw_rad_;  // of the odometry at the last frame
  double stand_turned_rad_ = 0.0;
  CorridorHint hint_;
  std::vector<Eigen::Vector2d> path_map_;  // what it means to drive, from about the car onwards
  std::optional<double> turn_side_;        // +1 left, -1 right, while it turns
};

}  // namespace merlin
