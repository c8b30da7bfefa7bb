// Who drives: an obstacle stop beats the operator's hand (unless he overrides it on purpose), the hand beats autonomy,
// and whoever lets go stops the car.
//
// The obstacle stop looks where the depth camera looks: ahead. Nothing watches the way back.
#pragma once

#include <optional>

#include "autonomy/avoid.h"
#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin {

// What the operator's hand says, as last heard of.
struct ManualWish {
  Time heard{0};               // when stick, keys or radio last gave sign of life
  bool held = false;           // the hand is on it: it is pushed, a key is down
  double speed_m_s = 0.0;      // negative: backwards
  double steering_rad = 0.0;   // of the virtual middle front wheel, positive: left
  bool override_stop = false;  // held down: drive on, whatever is in the way
  bool autonomy = false;       // switched on: the pilot may drive while the hand is off
  bool quit = false;           // the drive is over
};

struct ArbitrateConfig {
  double silent_after_s = 0.5;   // [0.05, 10] without sign of life the link is lost: everything stops; guess
  double blind_after_s = 0.5;    // [0.05, 10] a view older than this shows no free way; guess
  double command_valid_s = 0.3;  // [0.02, 5] the car brakes by itself when no command follows
  double way_m = 4.0;            // [0.5, 20] of the arc ahead that is watched
};

template <class Visitor>
void Visit(Visitor& v, ArbitrateConfig& c) {
  v("silent_after_s", c.silent_after_s, {0.05, 10.0});
  v("blind_after_s", c.blind_after_s, {0.05, 10.0});
  v("command_valid_s", c.command_valid_s, {0.02, 5.0});
  v("way_m", c.way_m, {0.5, 20.0});
}

enum class Driver { kNobody, kManual, kAutonomy, kObstacleStop };

// "nobody", "manual", "autonomy", "obstacle stop"
const char* Name(Driver driver);

struct Arbitration {
  DriveCommand command;  // finite, and always one: to stand where nobody drives
  Driver driver = Driver::kNobody;
};

class Arbiter {
 public:
  Arbiter(const CarDescription& car, const AvoidConfig& avoid, const ArbitrateConfig& config)
      : car_(car), config_(config), avoid_(FootprintOf(car), avoid) {}

  // autonomy: what the pilot would do, if it may drive at all; it has looked out for obstacles itself. seen: the newest
  // view, null before the first. A wish that is not finite is a hand that is off.
  Arbitration Decide(Time now, const ManualWish& wish, const std::optional<DriveCommand>& autonomy,
                     const Observation* seen);

 private:
  double SpeedLimit_m_s(Time now, const ManualWish& wish, const Observation* seen);

  CarDescription car_;
  ArbitrateConfig config_;
  Avoid avoid_;
};

}  // namespace merlin
