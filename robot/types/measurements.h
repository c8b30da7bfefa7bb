// What the other devices deliver and take. Stamps are the middle of the exposure or sampling instant.
#pragma once

#include <cstdint>

#include "robot/types/color_camera.h"
#include "robot/types/time.h"

namespace merlin {

// Attitude of the body: rotation about x, y, z (roll, pitch, yaw; R = Rz Ry Rx), yaw counter-clockwise from the world's x axis.
struct CompassReading {
  Time stamp{0};
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;  // in (-pi, pi]
};

// A command to the car, and how long it is valid. When it expires (at once if a number is not finite), the motor is
// braked within 200 ms.
struct DriveCommand {
  double speed_m_s = 0.0;     // of the rear axle's middle, negative: backwards
  double steering_rad = 0.0;  // of the virtual middle front wheel, positive: left
  Duration valid_for{0};
};

struct DriveState {
  Time stamp{0};
  std::int64_t encoder_counts = 0;  // of the motor shaft, forwards positive
  double steering_rad = 0.0;        // of the virtual middle front wheel, as the servo reports it
  double current_a = 0.0;
  double battery_v = 0.0;
  bool expired = false;  // the last command has expired: the motor is braked
};

// The angle of a unit that turns the cameras, or of a turntable that turns the whole car.
struct PanState {
  Time stamp{0};
  double angle_rad = 0.0;  // counter-clockwise seen from above, 0: straight ahead
};

}  // namespace merlin
