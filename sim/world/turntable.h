// A turntable that holds the car's wheels off the floor and turns the car about a vertical axis (through the origin of
// CarDescription::T_base_turntable), so that a room can be mapped from one place. It sets the car's pose and velocity
// directly; forces do not count. The turntable itself is invisible and nothing collides with it.
#pragma once

#include "robot/types/car.h"
#include "robot/types/se3.h"
#include "robot/types/time.h"

namespace merlin::sim {

constexpr double kTurntableHeight_m = 0.05;  // of the wheels above the floor

class Turntable {
 public:
  Turntable() = default;
  // T_world_base: pose of the car at turntable angle 0.
  Turntable(const CarDescription& car, const Pose& T_world_base, double rate_rad_s)
      : T_world_table_(T_world_base * car.T_base_turntable()),
        T_table_base_(car.T_base_turntable().inverse()),
        rate_rad_s_(rate_rad_s) {}

  // Sets the target angle, counter-clockwise seen from above, any number of turns. The turntable moves there at its
  // constant rate. A value that is not finite is ignored.
  void Send(double angle_rad);
  void Step(Duration duration);

  double angle_rad() const { return angle_rad_; }
  double speed_rad_s() const { return speed_rad_s_; }  // during the last step
  Pose T_world_base() const { return T_world_table_ * FromXyYaw(0.0, 0.0, angle_rad_) * T_table_base_; }

 private:
  Pose T_world_table_ = Pose::Identity(), T_table_base_ = Pose::Identity();
  double rate_rad_s_ = 0.0, target_rad_ = 0.0, angle_rad_ = 0.0, speed_rad_s_ = 0.0;
};

}  // namespace merlin::sim
