#include "sim/drive/encoder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/base/random.h"

namespace merlin::sim {
namespace {

// Friction of bearings and grease, which holds the rotor inside the backlash against smaller torques (this one takes
// half an ampere). A guess. Without it the ripple of the speed loop would rattle the rotor back and forth, which the
// rolling resistance of a real car prevents.
constexpr double kFriction_n_m = 0.015;

}  // namespace

Encoder::Encoder(const DrivetrainConfig& config, int counts_per_turn, double rotor_inertia_kg_m2, std::uint64_t seed)
    : config_(config),
      counts_per_rad_(counts_per_turn / (2.0 * std::numbers::pi)),
      rotor_inertia_kg_m2_(rotor_inertia_kg_m2),
      seed_(seed) {}

void Encoder::Follow(double wheels_rad, double torque_n_m, double step_s) {
  MoveInPlay(torque_n_m, step_s);
  const std::int64_t passed = std::llround((wheels_rad + ahead_rad_) * counts_per_rad_);
  const std::int64_t counted = std::abs(passed - passed_) - Missed(std::abs(passed - passed_));
  counts_ += passed > passed_ ? counted : -counted;
  passed_ = passed;
  ++step_;
}

// The rotor moves freely between the tooth flanks and stops at them without rebound.
void Encoder::MoveInPlay(double torque_n_m, double step_s) {
  const double play_rad = 0.5 * config_.gear_backlash_rad;
  const double free_n_m = std::copysign(std::max(std::abs(torque_n_m) - kFriction_n_m, 0.0), torque_n_m);
  if (free_n_m == 0.0) ahead_rad_s_ = 0.0;
  ahead_rad_s_ += free_n_m / rotor_inertia_kg_m2_ * step_s;
  const double ahead_rad = ahead_rad_ + ahead_rad_s_ * step_s;
  ahead_rad_ = std::clamp(ahead_rad, -play_rad, play_rad);
  if (ahead_rad_ != ahead_rad) ahead_rad_s_ = 0.0;
}

// How many of the edges that passed in this step the counter missed.
std::int64_t Encoder::Missed(std::int64_t passed) {
  if (config_.missed_counts <= 0.0 || passed == 0) return 0;
  Random random(seed_, Sensor::kDrive, step_);
  std::int64_t missed = 0;
  for (std::int64_t edge = 0; edge < passed; ++edge) missed += random.Uniform() < config_.missed_counts ? 1 : 0;
  return missed;
}

}  // namespace merlin::sim
