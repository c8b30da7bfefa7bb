// The numbers of a drivetrain, wherever they are written: an element of the URDF or a map of its mapping.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "robot/base/error.h"
#include "robot/types/car.h"

namespace merlin {

// positive(name) gives the positive number of that name or throws.
template <class Positive>
Drivetrain DrivetrainOf(const std::string& where, const std::string& what, Positive positive) {
  Drivetrain d;
  d.gear = positive("gear");
  const double counts = positive("encoder_counts_per_motor_turn");
  if (counts != std::floor(counts) || counts > 1e6)
    throw InputError(where, what + " 'encoder_counts_per_motor_turn'", "a whole number up to 1000000",
                     fmt::format("{}", counts));
  d.encoder_counts_per_motor_turn = static_cast<int>(counts);
  d.motor_constant_v_s = positive("motor_constant_v_s");
  d.resistance_ohm = positive("resistance_ohm");
  d.rotor_inertia_kg_m2 = positive("rotor_inertia_kg_m2");
  d.voltage_max_v = positive("voltage_max_v");
  d.speed_max_m_s = positive("speed_max_m_s");
  d.acceleration_max_m_s2 = positive("acceleration_max_m_s2");
  d.steering_slew_rad_s = positive("steering_slew_rad_s");
  d.tyre_friction = positive("tyre_friction");
  return d;
}

}  // namespace merlin
