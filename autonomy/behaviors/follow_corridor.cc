#include "autonomy/behaviors/follow_corridor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace merlin {
namespace {

constexpr double kPlannedStep_m = 0.05;
constexpr double kStraight_m = 4.0;
constexpr double kLapEnd_m = 1.5;  // a lap ends at most this far beyond the start line and beside it: half a corridor

// Adds points of a straight line that begins at a point.
void AddStraight(std::vector<Eigen::Vector2d>& path, const Eigen::Vector2d& from, double yaw_rad, double length_m) {
  const Eigen::Vector2d direction(std::cos(yaw_rad), std::sin(yaw_rad));
  for (double s = 0.0; s < length_m; s += kPlannedStep_m) path.push_back(from + s * direction);
}

}  // namespace

Intent FollowCorridor::Decide(const Situation& situation) {
  const Pose& T_map_base = *situation.T_map_base;
  if (situation.T_map_before) ChangeMap(*situation.T_map_before);
  if (!T_map_start_) Start(T_map_base);
  if (situation.taken_over) ForgetPlan();
  CountLaps(T_map_base);
  Intent intent;
  if (laps_wanted_ > 0 && laps_ >= laps_wanted_) {
    intent.done = true;
    return intent;
  }
  if (turn_side_ && TurnIsOver(T_map_base)) turn_side_.reset();
  if (!turn_side_) PlanAhead(situation);

  intent.path_map = path_map_;
  intent.speed_m_s = turn_side_ ? config_.turn_speed_m_s : config_.speed_m_s;
  intent.activity = !turn_side_         ? Activity::kFollowsCorridor
                    : *turn_side_ > 0.0 ? Activity::kTurnsLeft
                                        : Activity::kTurnsRight;
  return intent;
}

void FollowCorridor::Start(const Pose& T_map_base) {
  T_map_start_ = T_map_base;
  last_yaw_rad_ = Yaw(T_map_base);
  hint_.yaw_rad = last_yaw_rad_;
}

// All that it remembers, in the new map frame.
void FollowCorridor::ChangeMap(const Pose& T_map_before) {
  if (T_map_start_) T_map_start_ = T_map_before * *T_map_start_;
  last_yaw_rad_ = WrapPi(last_yaw_rad_ + Yaw(T_map_before));
  hint_.yaw_rad = WrapPi(hint_.yaw_rad + Yaw(T_map_before));
  for (Eigen::Vector2d& point : path_map_)
    point = (T_map_before * Eigen::Vector3d(point.x(), point.y(), 0.0)).head<2>();
}

// A lap: the car has turned by a full circle and is back in the corridor of its start, just beyond the start line.
void FollowCorridor::CountLaps(const Pose& T_map_base) {
  turned_rad_ += WrapPi(Yaw(T_map_base) - last_yaw_rad_);
  last_yaw_rad_ = Yaw(T_map_base);
  const Eigen::Vector3d from_start = T_map_start_->inverse() * T_map_base.translation();
  const bool round = std::abs(turned_rad_) > 2.0 * std::numbers::pi * (laps_ + 1) - 0.3;
  const double beyond_m = from_start.x() - config_.lap_overlap_m;
  if (round && beyond_m >= 0.0 && beyond_m < kLapEnd_m && std::abs(from_start.y()) < kLapEnd_m) ++laps_;
}

// The corridor now leads where the car looks. The laps still count.
void FollowCorridor::ForgetPlan() {
  turn_side_.reset();
  path_map_.clear();
  hint_ = {last_yaw_rad_, std::nullopt};
}

void FollowCorridor::PlanAhead(const Situation& situation) {
  const Pose& T_map_base = *situation.T_map_base;
  const Corridor corridor = SeeCorridor(situation.local_map, situation.grid, T_map_base, hint_, config_.corridor);
  hint_ = {corridor.yaw_rad, corridor.width_m};
  const Pose T_map_axis = corridor.T_map_axis(T_map_base);
  path_map_.clear();
  AddStraight(path_map_, (T_map_axis * Eigen::Vector3d(0.0, corridor.middle_m, 0.0)).head<2>(), corridor.yaw_rad,
              kStraight_m);
  if (corridor.front_m && *corridor.front_m < config_.decide_m) {
    if (corridor.left_open)
      PlanTurn(corridor, T_map_base, 1.0);
    else if (corridor.right_open)
      PlanTurn(corridor, T_map_base, -1.0);
  }
}

// Straight on to the arc, a quarter circle, straight on along the middle of the next corridor, which is taken to be as
// wide as this one.
void FollowCorridor::PlanTurn(const Corridor& corridor, const Pose& T_map_base, double side) {
  const double half_m = 0.5 * corridor.width_m.value_or(2.0 * config_.corridor.side_distance_m);
  const Pose T_map_axis = corridor.T_map_axis(T_map_base);
  const double radius_m = config_.turn_radius_m;
  const double arc_begin_m = *corridor.front_m - half_m - radius_m;  // the middle lines meet a radius farther
  const auto at = [&](double x, double y) -> Eigen::Vector2d {
    return (T_map_axis * Eigen::Vector3d(x, corridor.middle_m + y, 0.0)).head<2>();
  };
  path_map_.clear();
  AddStraight(path_map_, at(std::min(0.0, arc_begin_m), 0.0), corridor.yaw_rad, std::max(0.0, arc_begin_m));
  for (double angle = 0.0; angle < 0.5 * std::numbers::pi; angle += kPlannedStep_m / radius_m)
    path_map_.push_back(at(arc_begin_m + radius_m * std::sin(angle), side * radius_m * (1.0 - std::cos(angle))));
  hint_.yaw_rad = WrapPi(corridor.yaw_rad + side * 0.5 * std::numbers::pi);
  AddStraight(path_map_, at(arc_begin_m + radius_m, side * radius_m), hint_.yaw_rad, kStraight_m);
  turn_side_ = side;
}

bool FollowCorridor::TurnIsOver(const Pose& T_map_base) const {
  return std::abs(WrapPi(Yaw(T_map_base) - hint_.yaw_rad)) < 0.15;
}

}  // namespace merlin
