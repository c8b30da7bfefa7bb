// The encoder on the motor shaft. It gives whole counts, of which some may be lost, and it moves relative to the wheels
// within the gear's backlash.
#pragma once

#include <cstdint>

#include "robot/types/drivetrain_config.h"

namespace merlin::sim {

class Encoder {
 public:
  Encoder() = default;
  Encoder(const DrivetrainConfig& config, int counts_per_turn, double rotor_inertia_kg_m2, std::uint64_t seed);

  // Follows the shaft over one step. wheels_rad: mean angle that the wheels have turned since the start, times the gear
  // ratio. torque_n_m: the motor's torque, which moves the rotor through the backlash until the gear carries it.
  void Follow(double wheels_rad, double torque_n_m, double step_s);
  std::int64_t counts() const { return counts_; }

 private:
  void MoveInPlay(double torque_n_m, double step_s);
  std::int64_t Missed(std::int64_t passed);

  DrivetrainConfig config_;
  double counts_per_rad_ = 0.0, rotor_inertia_kg_m2_ = 1.0;
  std::uint64_t seed_ = 0, step_ = 0;
  double ahead_rad_ = 0.0, ahead_rad_s_ = 0.0;  // rotor ahead of the wheels, at most half the backlash
  std::int64_t passed_ = 0, counts_ = 0;        // edges passed since the start, and edges counted
};

}  // namespace merlin::sim
