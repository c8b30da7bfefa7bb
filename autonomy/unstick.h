// Keeps the car from standing for good: watches for a car that waits, is lost or has nothing to hold on to, and says when
// to help it.
//
//   waits or is lost for back_after_s  ->  it backs a little once, over ground that is known to be free
//   waits or is lost for end_after_s   ->  the run ends, with the reason
//   drives without a hold (lost, or only a floor in view) for end_after_s, less the time with one  ->  the same
//   drives on, away_m from there       ->  all is forgotten
//
// Backing gives the camera another view of what was too near to measure, or of a place that did not fit the map. Only
// the time in which the car waits counts. Nothing counts while a task is done, on the turntable, while an operator drives,
// or while mapping waits for the heading.
#pragma once

#include <optional>
#include <string>

#include "autonomy/intent.h"
#include "autonomy/situation.h"
#include "robot/base/config.h"

namespace merlin {

struct UnstickConfig {
  double back_after_s = 6.0;  // [0.5, 1e6] a visitor may have gone by then; guess
  double back_m = 0.4;        // [0, 2] how far it backs; 0: not at all. Close walls are 0.5 m away then; guess
  double end_after_s = 15.0;  // [1, 1e6] of waiting in one place, or of driving without anything to hold on to; guess
  double away_m = 1.0;        // [0.1, 100] farther from where it began to wait, the car has got away; guess
};

template <class Visitor>
void Visit(Visitor& v, UnstickConfig& c) {
  v("back_after_s", c.back_after_s, {0.5, 1e6});
  v("back_m", c.back_m, {0.0, 2.0});
  v("end_after_s", c.end_after_s, {1.0, 1e6});
  v("away_m", c.away_m, {0.1, 100.0});
}

class Unstick {
 public:
  explicit Unstick(const UnstickConfig& config) : config_(config) {}

  // Once a decision. activity: what the car would do without help.
  void Watch(const Situation& situation, Activity activity);

  bool backs() const { return backs_from_.has_value(); }  // the car is to back now
  void CannotBack() { backs_from_.reset(); }              // the ground behind it is not known to be free
  double waited_s() const { return waited_s_; }           // in this place
  bool gives_up() const { return waited_s_ >= config_.end_after_s || unheld_s_ >= config_.end_after_s; }

 private:
  void Forget();
  void WatchHold(const Situation& situation, Activity activity, double step_s);

  UnstickConfig config_;
  std::optional<Time> last_;
  std::optional<Pose> T_odom_stuck_;  // where it began to wait
  double backing_s_ = 0.0;            // since it began to back
  std::optional<Pose> backs_from_;    // where it began to back, in the odometry's frame
  bool backed_ = false;               // since then
  double waited_s_ = 0.0, unheld_s_ = 0.0;
};

// Why the car waits, for people: "an obstacle is 0.42 m ahead", "97 % of the depth camera's pixels are saturated", ...
// free_m: distance to what is ahead, as far as known. waited_s: how long the car has waited.
std::string WhyStuck(const Situation& situation, Activity activity, std::optional<double> free_m, double waited_s);

}  // namespace merlin
