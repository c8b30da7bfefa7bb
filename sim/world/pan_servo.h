// The servo that turns both cameras about the vertical: a stiff position loop with slew, 0 to 180 deg at its horn and
// 90 ahead (thesis, section 6's future), which is -90 to 90 deg here. It holds its angle when nothing is sent.
//
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"

namespace merlin::sim {

class PanServo {
 public:
  // Adds the servo to a spec that holds the joint of car.pan.
  static void AddTo(mjSpec* spec, const CarDescription& car);

  PanServo() = default;
  PanServo(const mjModel* model, const CarDescription& car);

  // Of the cameras, counter-clockwise seen from above, 0: ahead. Clamped to the joint's limits; not finite: ignored.
  void Send(double angle_rad);
  // Writes data->ctrl for the coming step.
  void Apply(mjData* data) const { data->ctrl[ctrl_] = target_rad_; }
  double Read_rad(const mjData* data) const { return data->qpos[qpos_]; }

 private:
  double min_rad_ = 0.0, max_rad_ = 0.0, target_rad_ = 0.0;
  int ctrl_ = -1, qpos_ = -1;  // addresses in mjData
};

}  // namespace merlin::sim
