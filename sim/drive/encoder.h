// The encoder on the motor's shaft: whole counts, behind the gear's play, some of them lost.
#pragma once

#include <cstdint>

#include "robot/types/drivetrain_config.h"

namespace merlin::sim {

class Encoder {
 public:
  Encoder() = default;
  Encoder(const DrivetrainConfig& config, int counts_per_turn, double rotor_inertia_kg_m2, std::uint64_t seed);

  // Follows the shaft over one step. wheels_rad: how far the wheels have turned since the start, their mean, times the
  // gear. torque_n_m: the motor's; it moves the rotor through the gear's play, to the side that then
  // carries it.
  void Follow(double wheels_rad, double torque_n_m, double step_s);
  std::int64_t counts() const { return counts_; }

 private:
  void MoveInPlay(double torque_n_m, double step_s);
  std::int64_t Missed(std::int64_t passed);

  DrivetrainConfig config_;
  double counts_per_rad_ = 0.0, rotor_inertia_kg_m2_ = 1.0;
  std::uint64_t seed_ = 0, step_ = 0;
  double ahead_rad_ = 0.0, ahead_rad_s_ = 0.0;  // of the rotor before the wheels: within half the play
  std::int64_t passed_ = 0, counts_ = 0;        // edges that went by since the start, and those that were counted
};

}  // namespace merlin::sim
