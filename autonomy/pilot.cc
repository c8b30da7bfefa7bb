#include "autonomy/pilot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/limits.h"
#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

constexpr double kPlannedStep_m = 0.05;
constexpr double kStraight_m = 4.0;
constexpr double kLapEnd_m = 1.5;  // beyond the line and beside it, at most: no farther than half a corridor

// Samples of a straight line from a point, direction as angle.
void AddStraight(std::vector<Eigen::Vector2d>& path, const Eigen::Vector2d& from, double yaw_rad, double length_m) {
  const Eigen::Vector2d direction(std::cos(yaw_rad), std::sin(yaw_rad));
  for (double s = 0.0; s < length_m; s += kPlannedStep_m) path.push_back(from + s * direction);
}

std::size_t NearestIndex(const std::vector<Eigen::Vector2d>& path, const Eigen::Vector2d& p) {
  const auto nearer = [&p](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  };
  return static_cast<std::size_t>(std::min_element(path.begin(), path.end(), nearer) - path.begin());
}

}  // namespace

std::vector<BehaviorInfo> Behaviors() {
  return {{"follow_corridor", "The car drives in the middle of a corridor and around its corners, for so many laps."},
          {"turn_on_stand", "The car stands on a turntable that turns it through an angle."}};
}

std::vector<std::string> BehaviorNames() {
  std::vector<std::string> names;
  for (const BehaviorInfo& behavior : Behaviors()) names.push_back(behavior.name);
  return names;
}

Pilot::Pilot(const CarDescription& car, const Task& task, const PilotConfig& config)
    : car_(car), task_(task), config_(config), avoid_(FootprintOf(car), config.avoid) {}

DriveCommand Pilot::Command(double speed_m_s, double steering_rad) const {
  return {.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = FromSeconds(config_.command_valid_s)};
}

void Pilot::CountLaps(const Pose& T_map_base) {
  turned_rad_ += WrapPi(Yaw(T_map_base) - last_yaw_rad_);
  last_yaw_rad_ = Yaw(T_map_base);
  const Eigen::Vector3d from_start = T_map_start_->inverse() * T_map_base.translation();
  const bool round = std::abs(turned_rad_) > 2.0 * std::numbers::pi * (laps_ + 1) - 0.3;
  // Beyond the start line, and in its corridor.
  const double beyond_m = from_start.x() - config_.lap_overlap_m;
  if (round && beyond_m >= 0.0 && beyond_m < kLapEnd_m && std::abs(from_start.y()) < kLapEnd_m) ++laps_;
}

void Pilot::FollowCorridor(const Pose& T_map_base, const Slam& slam) {
  const Corridor corridor = SeeCorridor(slam.local_map(), slam.occupancy(), T_map_base, hint_, config_.corridor);
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

void Pilot::PlanTurn(const Corridor& corridor, const Pose& T_map_base, double side) {
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

bool Pilot::TurnIsOver(const Pose& T_map_base) const {
  return std::abs(WrapPi(Yaw(T_map_base) - hint_.yaw_rad)) < 0.15;
}

Pilot::Pursuit Pilot::Pursue(const std::vector<Eigen::Vector2d>& path_base) const {
  // Pure pursuit (Coulter 1992): the arc through the first path point a look-ahead away.
  auto far = std::ranges::find_if(
      path_base, [this](const Eigen::Vector2d& p) { return p.x() > 0.0 && p.norm() >= config_.look_ahead_m; });
  if (far == path_base.end()) far = std::prev(path_base.end());
  const double curvature_1_m = 2.0 * far->y() / std::max(far->squaredNorm(), 0.04);
  Pursuit pursuit;
  pursuit.steering_rad = ClampSteering_rad(car_, WheelsAngleForCurvature_rad(car_, curvature_1_m));
  pursuit.way_base = ArcAhead(car_, pursuit.steering_rad, far->norm());
  pursuit.way_base.insert(pursuit.way_base.end(), far, path_base.end());
  return pursuit;
}

void Pilot::Forget() {
  turn_side_.reset();
  path_map_.clear();
  hint_ = {last_yaw_rad_, std::nullopt};
}

Decision Pilot::TurnOnStand(const Observation& observation) {
  constexpr double kThere_rad = 1e-3;  // a turntable's reading goes all the way
  const double yaw_rad = Yaw(observation.T_odom_base), angle_rad = task_.angle_deg * std::numbers::pi / 180.0;
  stand_turned_rad_ += WrapPi(yaw_rad - stand_yaw_rad_.value_or(yaw_rad));
  stand_yaw_rad_ = yaw_rad;
  const bool done = std::abs(stand_turned_rad_ - angle_rad) < kThere_rad;
  return {Command(0.0, 0.0), done, done ? "is done" : "turns on its stand", angle_rad};
}

Decision Pilot::Decide(const Observation& observation, const std::optional<Pose>& T_map_base, const Slam& slam) {
  if (!T_map_base) return {Command(0.0, 0.0), false, "waits for its heading"};
  if (!T_map_start_) {
    T_map_start_ = *T_map_base;
    last_yaw_rad_ = Yaw(*T_map_base);
    hint_.yaw_rad = last_yaw_rad_;
  }
  if (IsOnStand(task_)) return TurnOnStand(observation);
  CountLaps(*T_map_base);
  if (task_.laps > 0 && laps_ >= task_.laps) return {Command(0.0, 0.0), true, "is done"};
  if (slam.lost_frames() > config_.lost_frames_max)
    return {Command(0.0, 0.0), false, "stands: it does not know where it is"};

  if (turn_side_ && TurnIsOver(*T_map_base)) turn_side_.reset();
  if (!turn_side_) FollowCorridor(*T_map_base, slam);

  const Pose T_base_map = T_map_base->inverse();
  std::vector<Eigen::Vector2d> path_base;
  for (std::size_t i = NearestIndex(path_map_, T_map_base->translation().head<2>()); i < path_map_.size(); ++i)
    path_base.push_back((T_base_map * Eigen::Vector3d(path_map_[i].x(), path_map_[i].y(), 0.0)).head<2>());

  const Pursuit pursuit = Pursue(path_base);
  const double limit_m_s = avoid_.SpeedLimit_m_s(avoid_.FreeDistance_m(observation, pursuit.way_base));
  const double wish_m_s = turn_side_ ? config_.turn_speed_m_s : config_.speed_m_s;
  const double speed_m_s = std::min(wish_m_s, limit_m_s) < 0.03 ? 0.0 : std::min(wish_m_s, limit_m_s);
  Decision decision{Command(speed_m_s, pursuit.steering_rad), false, "follows the corridor"};
  if (turn_side_) decision.doing = *turn_side_ > 0.0 ? "turns left" : "turns right";
  if (speed_m_s == 0.0) decision.doing = "waits for an obstacle";
  return decision;
}

}  // namespace merlin
