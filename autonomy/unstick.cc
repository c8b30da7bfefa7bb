#include "autonomy/unstick.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace merlin {
namespace {

constexpr double kStep_max_s = 1.0;     // a longer gap between two decisions is not the car's waiting
constexpr double kBacking_max_s = 6.0;  // wheels that turn and do not move the car
constexpr int kBlip_frames = 5;         // lost for no more frames in a row is of no account
constexpr double kMostOf = 0.5;         // a share of pixels that explains why nothing else is seen

bool Waits(Activity activity) {
  return activity == Activity::kIsLost || activity == Activity::kWaitsForObstacle ||
         activity == Activity::kWaitsForFreeGround || activity == Activity::kSeesTooLittle;
}

bool Drives(Activity activity) {
  return activity == Activity::kFollowsCorridor || activity == Activity::kTurnsLeft ||
         activity == Activity::kTurnsRight || activity == Activity::kFollowsPath || activity == Activity::kBacks;
}

double Distance_m(const Pose& T_odom_a, const Pose& T_odom_b) {
  return (T_odom_a.translation() - T_odom_b.translation()).norm();
}

std::string Text(const char* format, double number) {
  char text[160];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

// What is wrong with the frame, if its pixels tell; else empty.
std::string WhatPixelsTell(const Observation& observation) {
  const auto& counts = observation.rejections;
  const double pixels = std::accumulate(counts.begin(), counts.end(), 0.0);
  if (pixels <= 0.0) return "";
  const auto share = [&](std::initializer_list<Rejection> reasons) {
    double count = 0.0;
    for (const Rejection reason : reasons) count += counts[static_cast<std::size_t>(reason)];
    return count / pixels;
  };
  const double saturated = share({Rejection::kSaturated}), dark = share({Rejection::kInvalid, Rejection::kLowSignal});
  const double doubtful = share({Rejection::kInconsistent, Rejection::kGhost, Rejection::kLonely});
  if (saturated >= kMostOf)
    return Text("%.0f %% of the depth camera's pixels are saturated: too near, too bright or exposed too long",
                100.0 * saturated);
  if (dark >= kMostOf)
    return Text("%.0f %% of the depth camera's pixels get no return: too far, too dark or exposed too shortly",
                100.0 * dark);
  if (doubtful >= kMostOf)
    return Text("%.0f %% of the depth camera's pixels contradict their neighbours or their brightness",
                100.0 * doubtful);
  return "";
}

std::string Cause(const Situation& situation, Activity activity, std::optional<double> free_m) {
  const std::string pixels = WhatPixelsTell(situation.observation);
  const std::string points =
      Text("%.0f points of the frame can be used", static_cast<double>(situation.observation.points_base.size()));
  switch (activity) {
    case Activity::kSeesTooLittle:
      return "it sees too little to begin a map: " + (pixels.empty() ? points : pixels);
    case Activity::kIsLost:
      return Text("it has been lost for %.0f frames: ", situation.lost_frames) +
             (pixels.empty() ? points + ", and they do not fit the map" : pixels);
    case Activity::kWaitsForFreeGround:
      return "it knows no free ground behind it";
    case Activity::kWaitsForObstacle:
      if (free_m && *free_m > 0.0) return Text("an obstacle is %.2f m ahead", *free_m);
      return "something is too near to measure, or the camera looks aside" + (pixels.empty() ? "" : ": " + pixels);
    default:
      if (situation.lost_frames == 0)
        return "registration finds nothing to hold on to: no wall or other upright surface is seen, only the floor";
      return "most frames do not fit the map: " + (pixels.empty() ? points : pixels);
  }
}

}  // namespace

void Unstick::Forget() {
  T_odom_stuck_.reset();
  backs_from_.reset();
  backed_ = false;
  waited_s_ = 0.0;
}

void Unstick::Watch(const Situation& situation, Activity activity) {
  const double step_s = last_ ? std::clamp(Seconds(situation.now - *last_), 0.0, kStep_max_s) : 0.0;
  last_ = situation.now;
  WatchHold(situation, activity, step_s);

  const Pose& T_odom_base = situation.observation.T_odom_base;
  if (situation.taken_over) Forget();
  if (T_odom_stuck_ && Distance_m(*T_odom_stuck_, T_odom_base) > config_.away_m) Forget();
  if (!Waits(activity)) {
    if (!Drives(activity)) Forget();
  } else if (!T_odom_stuck_) {
    T_odom_stuck_ = T_odom_base;
  } else {
    waited_s_ += step_s;
  }
  backing_s_ += step_s;
  if (backs_from_ && (Distance_m(*backs_from_, T_odom_base) >= config_.back_m || backing_s_ > kBacking_max_s))
    backs_from_.reset();
  if (!backed_ && waited_s_ >= config_.back_after_s && activity != Activity::kSeesTooLittle && config_.back_m > 0.0) {
    backed_ = true;
    backs_from_ = T_odom_base;
    backing_s_ = 0.0;
  }
}

// A car may be lost, map on, and be lost again: it moves and gets nowhere. So time with a hold only takes back as much time
// without one.
void Unstick::WatchHold(const Situation& situation, Activity activity, double step_s) {
  if (situation.taken_over || !(Drives(activity) || Waits(activity))) unheld_s_ = 0.0;
  const bool unheld = situation.lost_frames > kBlip_frames || !situation.holds_position;
  unheld_s_ = std::max(0.0, unheld_s_ + (unheld ? step_s : -step_s));
}

std::string WhyStuck(const Situation& situation, Activity activity, std::optional<double> free_m, double waited_s) {
  const std::string cause = Cause(situation, activity, free_m);
  return Waits(activity) ? Text("the car had waited for %.0f s: ", waited_s) + cause : "the car gave up: " + cause;
}

}  // namespace merlin
