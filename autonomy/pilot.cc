#include "autonomy/pilot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "robot/kinematics/limits.h"
#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

constexpr double kBack_m_s = 0.2;  // out of a place where the car is stuck
constexpr double kArc_m = 4.0;     // of the arc that is checked where the behaviour gives no path

Behavior MakeBehavior(const Task& task, const BehaviorConfig& config) {
  const BehaviorInfo* const info = FindBehavior(task.behavior);
  if (info == nullptr) throw std::logic_error("no behavior is called '" + task.behavior + "'");
  return info->make(task, config);
}

}  // namespace

Pilot::Pilot(const CarDescription& car, const Task& task, const PilotConfig& config)
    : Pilot(car, MakeBehavior(task, config.behavior), config) {}

Pilot::Pilot(const CarDescription& car, Behavior behavior, const PilotConfig& config)
    : car_(car),
      footprint_(FootprintOf(car)),
      behavior_(std::move(behavior)),
      config_(config),
      avoid_(footprint_, config.avoid),
      unstick_(config.unstick),
      look_around_(car, config.look_around) {}

Decision Pilot::Decide(const Situation& situation) {
  look_at_.reset();
  Decision decision = DecideUnstuck(situation);
  const bool lost = situation.lost_frames > config_.lost_frames_max;
  decision.pan_rad = look_around_.Next_rad(situation.observation, look_at_, lost);
  return decision;
}

Decision Pilot::DecideUnstuck(const Situation& situation) {
  Decision decision = DecideByTask(situation);
  unstick_.Watch(situation, decision.activity);
  if (unstick_.backs()) {
    Decision back =
        Drive(situation, {.direction = Direction::kBackwards, .speed_m_s = kBack_m_s, .activity = Activity::kBacks});
    back.doing = decision.doing + ", and backs to see more";
    if (back.command.speed_m_s < 0.0) return back;
    unstick_.CannotBack();
  }
  if (unstick_.gives_up()) decision.gives_up = WhyStuck(situation, decision.activity, free_m_, unstick_.waited_s());
  return decision;
}

Decision Pilot::DecideByTask(const Situation& situation) {
  if (!situation.T_map_base) return Halt(Activity::kWaitsForHeading);
  Intent intent = behavior_(situation);
  if (intent.doing.empty()) intent.doing = Sentence(intent.activity);
  if (situation.searching) {
    intent.doing += " and searches for its place in the map";
    intent.speed_m_s = std::min(intent.speed_m_s, config_.search_speed_m_s);
  }
  if (intent.done || intent.speed_m_s <= 0.0)
    return {.command = Command(0.0, intent.steering_rad),
            .done = intent.done,
            .activity = intent.activity,
            .doing = intent.doing,
            .turntable_rad = intent.turntable_rad};
  if (!situation.has_map) return Halt(Activity::kSeesTooLittle);
  if (situation.lost_frames > config_.lost_frames_max) return Halt(Activity::kIsLost);
  return Drive(situation, intent);
}

Decision Pilot::Halt(Activity activity) const { return {Command(0.0, 0.0), false, activity, Sentence(activity)}; }

Decision Pilot::Drive(const Situation& situation, const Intent& intent) {
  const bool backwards = intent.direction == Direction::kBackwards;
  Pursuit pursuit;
  double end_limit_m_s = HUGE_VAL;
  if (intent.path_map.empty()) {
    pursuit.steering_rad = ClampSteering_rad(car_, intent.steering_rad);
    pursuit.path_base = ArcAhead(car_, pursuit.steering_rad, backwards ? -kArc_m : kArc_m);
  } else {
    const std::vector<Eigen::Vector2d> path_base = RestOfPath(intent.path_map, *situation.T_map_base);
    pursuit = Pursue(car_, path_base, intent.direction, config_.look_ahead_m);
    end_limit_m_s = SpeedToStopWithin_m_s(Length_m(path_base, intent.direction), config_.avoid.deceleration_m_s2);
  }
  const double limit_m_s = SpeedLimit_m_s(situation, pursuit, intent.direction);
  double speed_m_s = std::min({intent.speed_m_s, limit_m_s, end_limit_m_s});
  if (speed_m_s < kCreep_m_s) speed_m_s = 0.0;

  Decision decision{.command = Command(backwards ? -speed_m_s : speed_m_s, pursuit.steering_rad),
                    .activity = intent.activity,
                    .doing = intent.doing,
                    .turntable_rad = intent.turntable_rad};
  if (limit_m_s < kCreep_m_s) {
    decision.activity = backwards ? Activity::kWaitsForFreeGround : Activity::kWaitsForObstacle;
    decision.doing = Sentence(decision.activity);
  }
  return decision;
}

// As fast as the obstacles ahead, or the free ground behind, allow.
double Pilot::SpeedLimit_m_s(const Situation& situation, const Pursuit& pursuit, Direction direction) {
  if (direction == Direction::kForwards) {
    if (!pursuit.path_base.empty()) look_at_ = avoid_.PathToLookAt(pursuit.path_base);
    free_m_ = avoid_.FreeDistance_m(situation.observation, pursuit.path_base);
    return std::min(avoid_.SpeedLimit_m_s(free_m_), look_around_.SpeedLimit_m_s(config_.avoid.aside_max_m));
  }
  const auto free_m = FreeGround_m(situation.grid, footprint_, *situation.T_map_base, pursuit.path_base, config_.back);
  if (!free_m) return config_.back.speed_max_m_s;
  return std::min(config_.back.speed_max_m_s, SpeedToStopWithin_m_s(*free_m, config_.avoid.deceleration_m_s2));
}

DriveCommand Pilot::Command(double speed_m_s, double steering_rad) const {
  return {.speed_m_s = speed_m_s, .steering_rad = steering_rad, .valid_for = FromSeconds(config_.command_valid_s)};
}

}  // namespace merlin
