// The servo that pans both cameras about the vertical axis: a stiff position loop with a limited slew rate. The servo
// of the thesis (proposed in its section 6 as future work) turns from 0 to 180 deg and points ahead at 90 deg; here the
// angle runs from -90 to 90 deg and 0 points ahead. The servo holds its angle between commands.
//
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include <mujoco/mujoco.h>

#include "robot/types/car.h"

namespace merlin::sim {

class PanServo {
 public:
  // Adds the servo's actuator to a spec that already has the joint of car.pan.
  static void AddTo(mjSpec* spec, const CarDescription& car);

  PanServo() = default;
  PanServo(const mjModel* model, const CarDescription& car);

  // Sets the pan angle of the cameras: counter-clockwise seen from above, 0 points ahead. Clamped to the joint's
  // limits; a value that is not finite is ignored.
  void Send(double angle_rad);
  // Writes data->ctrl for the coming step.
  void Apply(mjData* data) const { data->ctrl[ctrl_] = target_rad_; }
  double Read_rad(const mjData* data) const { return data->qpos[qpos_]; }

 private:
  double min_rad_ = 0.0, max_rad_ = 0.0, target_rad_ = 0.0;
  int ctrl_ = -1, qpos_ = -1;  // addresses in mjData
};

}  // namespace merlin::sim
