// The numbers of a drivetrain, wherever they are written: attributes of the URDF's <drivetrain>, or a map of the car's
// mapping.
#pragma once

#include "robot/base/yaml_reader.h"
#include "robot/types/car.h"

namespace merlin {

// number(name, value, range) takes one of them; a drivetrain needs them all.
template <class Number>
void EachDrivetrainNumber(Drivetrain& d, Number number) {
  number("gear", d.gear, kPositive);
  number("encoder_counts_per_motor_turn", d.encoder_counts_per_motor_turn, Range{1, 1e6});
  number("motor_constant_v_s", d.motor_constant_v_s, kPositive);
  number("resistance_ohm", d.resistance_ohm, kPositive);
  number("rotor_inertia_kg_m2", d.rotor_inertia_kg_m2, kPositive);
  number("voltage_max_v", d.voltage_max_v, kPositive);
  number("speed_max_m_s", d.speed_max_m_s, kPositive);
  number("acceleration_max_m_s2", d.acceleration_max_m_s2, kPositive);
  number("steering_slew_rad_s", d.steering_slew_rad_s, kPositive);
  number("tyre_friction", d.tyre_friction, kPositive);
}

}  // namespace merlin
