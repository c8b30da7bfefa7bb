// The car drives in the middle of a corridor and around its corners, and is done after so many laps.
//
// At every frame it looks at the walls in the local map (corridor.h) and plans a straight path along the middle line. When
// the end wall comes near and a side is open, it plans a quarter circle into that side (left before right) and keeps to
// this plan until the car has turned. In a dead end it keeps its straight path: the pilot stops the car before the wall.
//
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "autonomy/behaviors/corridor.h"
#include "autonomy/intent.h"
#include "autonomy/situation.h"
#include "robot/base/config.h"

namespace merlin {

struct FollowCorridorConfig {
  double speed_m_s = 0.5;       // [0.05, 2] along a corridor; the thesis' indoor mapping speed
  double turn_speed_m_s = 0.4;  // [0.05, 2] around a corner
  double turn_radius_m = 0.9;   // [0.3, 5] of the arc around a corner; the smallest of the car is 0.71
  double decide_m = 2.6;        // [0.5, 7] distance to the end wall at which it decides where to turn
  double lap_overlap_m = 0.7;  // [0, 5] a lap ends this far beyond its start line, so that its end sees its start again
  CorridorConfig corridor;
};

template <class Visitor>
void Visit(Visitor& v, FollowCorridorConfig& c) {
  v("speed_m_s", c.speed_m_s, {0.05, 2.0});
  v("turn_speed_m_s", c.turn_speed_m_s, {0.05, 2.0});
  v("turn_radius_m", c.turn_radius_m, {0.3, 5.0});
  v("decide_m", c.decide_m, {0.5, 7.0});
  v("lap_overlap_m", c.lap_overlap_m, {0.0, 5.0});
  v("corridor", c.corridor);
}

class FollowCorridor {
 public:
  // laps: after which it is done; 0: endless.
  FollowCorridor(int laps, const FollowCorridorConfig& config) : laps_wanted_(laps), config_(config) {}
  Intent Decide(const Situation& situation);

 private:
  void Start(const Pose& T_map_base);
  void CountLaps(const Pose& T_map_base);
  void ChangeMap(const Pose& T_map_before);
  void ForgetPlan();
  void PlanAhead(const Situation& situation);
  void PlanTurn(const Corridor& corridor, const Pose& T_map_base, double side);
  bool TurnIsOver(const Pose& T_map_base) const;

  int laps_wanted_;
  FollowCorridorConfig config_;
  std::optional<Pose> T_map_start_;
  double last_yaw_rad_ = 0.0;  // of the car in the map, at the last frame
  double turned_rad_ = 0.0;    // since the start, not wrapped
  int laps_ = 0;
  CorridorHint hint_;                      // where the corridor leads, as far as known
  std::vector<Eigen::Vector2d> path_map_;  // the plan
  std::optional<double> turn_side_;        // +1 left, -1 right, while it turns
};

}  // namespace merlin
