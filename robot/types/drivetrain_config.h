// The errors of the twin's drive, as a real car has them. For each field one value switches its error off;
// IdealDrivetrain() sets all of these.
//
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include <string>

#include "robot/base/config.h"

namespace merlin {

// Ten nickel-metal-hydride cells: their voltage falls with the charge, and with the current.
struct BatteryConfig {
  bool always_nominal = false;   // true: a laboratory supply that always gives the car's nominal voltage
  double capacity_ah = 3.3;      // [0.001, 1000] C-size cells; guess
  double charge = 1.0;           // [0, 1] share of the capacity at the start
  double resistance_ohm = 0.08;  // [0, 10] of ten cells and their leads: sags by this times the current; guess
  double load_a = 1.5;           // [0, 100] what electronics, PC and cameras draw all the time; guess (18 W)
};

template <class Visitor>
void Visit(Visitor& v, BatteryConfig& c) {
  v("always_nominal", c.always_nominal);
  v("capacity_ah", c.capacity_ah, {0.001, 1000.0});
  v("charge", c.charge, {0.0, 1.0});
  v("resistance_ohm", c.resistance_ohm, {0.0, 10.0});
  v("load_a", c.load_a, {0.0, 100.0});
}

struct DrivetrainConfig {
  bool ideal = false;  // true: IdealDrivetrain(), whatever the rest says

  // Microcontroller and motor
  double speed_loop_s = 0.01;      // [0, 0.05] period of the speed loop, which knows whole counts only; 0: every
                                   // physics step, from the true speed. Guess
  double pwm_steps = 1000.0;       // [0, 65536] of the H-bridge's duty from 0 to 1; 0: any duty. 20 MHz controller
                                   // at 20 kHz: computed
  double gear_backlash_rad = 0.1;  // [0, 1] of the motor shaft, between encoder and wheels; 0.6 deg at the wheel; guess
  double missed_counts = 0.0;      // [0, 0.5] share of the encoder's counts that get lost, each by chance

  // Steering servo: 2.0 ms full left, 1.6 ms straight, 1.0 ms full right
  double servo_period_s = 0.02;          // [0, 0.1] between two pulses, 50 Hz (thesis); 0: takes angles, at every step
  double servo_dead_band_us = 5.0;       // [0, 100] a pulse that differs by no more moves nothing; guess
  double steering_backlash_rad = 0.003;  // [0, 0.1] between servo, which reports, and wheels; 0.17 deg, guess
  double steering_offset_rad = 0.0;  // [-0.2, 0.2] of the wheels from what the servo reports; a calibration finds it

  // True size over described size; 1: the car is as its description says. A calibration finds them.
  double wheel_radius_factor = 1.0;  // [0.8, 1.2] all wheels
  double wheelbase_factor = 1.0;     // [0.8, 1.2]

  std::string surface{};  // of all floors, a material in materials.yaml with its grip; empty: the room's own

  BatteryConfig battery{};
};

template <class Visitor>
void Visit(Visitor& v, DrivetrainConfig& c) {
  v("ideal", c.ideal);
  v("speed_loop_s", c.speed_loop_s, {0.0, 0.05});
  v("pwm_steps", c.pwm_steps, {0.0, 65536.0});
  v("gear_backlash_rad", c.gear_backlash_rad, {0.0, 1.0});
  v("missed_counts", c.missed_counts, {0.0, 0.5});
  v("servo_period_s", c.servo_period_s, {0.0, 0.1});
  v("servo_dead_band_us", c.servo_dead_band_us, {0.0, 100.0});
  v("steering_backlash_rad", c.steering_backlash_rad, {0.0, 0.1});
  v("steering_offset_rad", c.steering_offset_rad, {-0.2, 0.2});
  v("wheel_radius_factor", c.wheel_radius_factor, {0.8, 1.2});
  v("wheelbase_factor", c.wheelbase_factor, {0.8, 1.2});
  v("surface", c.surface);
  v("battery", c.battery);
}

// A drive without errors, which no real car has: for tests of everything but the drive.
inline DrivetrainConfig IdealDrivetrain() {
  DrivetrainConfig ideal{.ideal = true};
  ideal.speed_loop_s = ideal.pwm_steps = ideal.gear_backlash_rad = 0.0;
  ideal.servo_period_s = ideal.servo_dead_band_us = ideal.steering_backlash_rad = 0.0;
  ideal.battery.always_nominal = true;
  return ideal;
}

}  // namespace merlin
