// Where the pan unit points the cameras. A lens with a narrow view shows too little at once: of a corridor it sees one
// wall or none, and close ahead less than the width of the car. So the camera sweeps from side to side:
//
//                 left                      each step is half the view, so that neighbouring frames overlap;
//             .  /                          a full sweep, there and back, must not take so long that the car
//        car -==--- middle of the path      drives on without having looked ahead (avoid.h)
//             '  \                          .
//                 right
//
// The sweep is centred on the path where the car could just still stop, which leads it into curves. It reaches as far as
// registration needs to see both walls, and over the width of the path. While the frames do not fit the map it reaches
// farther. A lens that sees all this at once holds straight ahead.
//
// The camera moves in steps, one after each frame, and rests while it exposes: a servo takes 25 ms for 0.08 rad.
//
// The thesis proposes to pan the camera (section 7.2): "Autonomous navigation and mapping of mobile robots based on 2D/3D
// cameras combination", University of Siegen, about 2011.
#pragma once

#include <cmath>
#include <optional>

#include "autonomy/path_ahead.h"
#include "perception/observation.h"
#include "robot/base/config.h"
#include "robot/types/car.h"

namespace merlin {

struct LookAroundConfig {
  double half_view_rad = 0.35;      // [0, 1.5] seen to either side, by one frame or by a sweep: the lens of 40 deg
  double half_view_lost_rad = 0.9;  // [0, 1.5] the same while the frames do not fit the map; guess
  double step_share = 0.5;          // [0.05, 1] of the view between two frames: the rest overlaps
  double moving_share = 0.5;        // [0.05, 1] of the time between two frames in which the servo may move
};

template <class Visitor>
void Visit(Visitor& v, LookAroundConfig& c) {
  v("half_view_rad", c.half_view_rad, {0.0, 1.5});
  v("half_view_lost_rad", c.half_view_lost_rad, {0.0, 1.5});
  v("step_share", c.step_share, {0.05, 1.0});
  v("moving_share", c.moving_share, {0.05, 1.0});
}

class LookAround {
 public:
  LookAround(const CarDescription& car, const LookAroundConfig& config) : car_(car), config_(config) {}

  // Once per frame: the angle that the pan unit is to take next; nothing where none turns the camera. across: of the
  // path ahead, in the base frame; none: straight ahead. lost: the frames do not fit the map.
  std::optional<double> Next_rad(const Observation& observation, const std::optional<PathAcross>& across, bool lost);

  // The speed at which a full sweep, there and back, takes nine tenths of this distance; infinite while the camera holds
  // still.
  double SpeedLimit_m_s(double distance_m) const { return period_s_ > 0.0 ? 0.9 * distance_m / period_s_ : HUGE_VAL; }

 private:
  struct Range {
    double right_rad, left_rad;  // of the pan angle
  };
  Range RangeFor(const Observation& observation, const std::optional<PathAcross>& across, bool lost) const;
  double Step_rad(const Observation& observation) const;

  CarDescription car_;
  LookAroundConfig config_;
  std::optional<Time> last_stamp_;
  double frame_s_ = 0.0;  // between two frames
  double angle_rad_ = 0.0;
  double side_ = 1.0;      // +1: it sweeps to the left
  double period_s_ = 0.0;  // of a full sweep, as last planned; 0: holds still
};

}  // namespace merlin
