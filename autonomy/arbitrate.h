// Who drives: the operator, autonomy or nobody.
//
//   obstacle stop  >  operator  >  autonomy  >  nobody
//
// An obstacle ahead stops the operator, unless the operator overrides it on purpose. The operator beats autonomy. Whoever
// lets go stops the car. The obstacle stop looks where the depth camera looks, which is ahead: an operator who backs is
// not watched.
#pragma once

#include <optional>

#include "autonomy/avoid.h"
#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/car.h"
#include "robot/types/measurements.h"

namespace merlin {

// What the operator commands with stick, keys or radio, as last heard.
struct ManualCommand {
  Time heard{0};               // the last sign of life of the input device
  bool held = false;           // the operator drives: the stick is pushed, a key is down
  double speed_m_s = 0.0;      // negative: backwards
  double steering_rad = 0.0;   // of the virtual middle front wheel, positive: left
  bool override_stop = false;  // held down: drive on in spite of obstacles
  bool autonomy = false;       // switched on: the pilot may drive while the operator does not
  bool quit = false;           // the drive is over
};

struct ArbitrateConfig {
  double silent_after_s = 0.5;   // [0.05, 10] without a sign of life the link is lost, and everything stops; guess
  double blind_after_s = 0.5;    // [0.05, 10] an observation older than this shows no free path; guess
  double command_valid_s = 0.3;  // [0.02, 5] the car brakes by itself when no command follows
  double watched_m = 4.0;        // [0.5, 20] of the arc ahead that the obstacle stop looks at; key: way_m
};

template <class Visitor>
void Visit(Visitor& v, ArbitrateConfig& c) {
  v("silent_after_s", c.silent_after_s, {0.05, 10.0});
  v("blind_after_s", c.blind_after_s, {0.05, 10.0});
  v("command_valid_s", c.command_valid_s, {0.02, 5.0});
  v("way_m", c.watched_m, {0.5, 20.0});
}

enum class Driver { kNobody, kManual, kAutonomy, kObstacleStop };

// "nobody", "manual", "autonomy", "obstacle stop"
const char* Name(Driver driver);

struct Arbitration {
  DriveCommand command;  // finite, and there always is one: to stand where nobody drives
  Driver driver = Driver::kNobody;
};

class Arbiter {
 public:
  Arbiter(const CarDescription& car, const AvoidConfig& avoid, const ArbitrateConfig& config)
      : car_(car), config_(config), avoid_(FootprintOf(car), avoid) {}

  // autonomy: what the pilot would do, if it may drive at all; it has looked out for obstacles itself. seen: the newest
  // observation; null before the first. A manual command that is not finite counts as none.
  Arbitration Decide(Time now, const ManualCommand& manual, const std::optional<DriveCommand>& autonomy,
                     const Observation* seen);

 private:
  double SpeedLimit_m_s(Time now, const ManualCommand& manual, const Observation* seen);

  CarDescription car_;
  ArbitrateConfig config_;
  Avoid avoid_;
};

}  // namespace merlin
