#include "sim/drive/battery.h"

#include <algorithm>
#include <array>

namespace merlin::sim {
namespace {

struct Knot {
  double charge;
  double share;  // open-circuit voltage over nominal voltage
};

// Open-circuit voltage of a nickel-metal-hydride cell at room temperature: steep near full and near empty, flat
// between. A guess that follows the usual shape of published discharge curves.
constexpr std::array<Knot, 7> kCurve{
    {{0.0, 0.83}, {0.05, 0.96}, {0.1, 1.0}, {0.2, 1.03}, {0.5, 1.06}, {0.9, 1.1}, {1.0, 1.17}}};

double CurveAt(double charge) {
  const auto above =
      std::find_if(kCurve.begin() + 1, kCurve.end() - 1, [&](const Knot& k) { return k.charge >= charge; });
  const Knot &to = *above, &from = *(above - 1);
  return from.share + (to.share - from.share) * (charge - from.charge) / (to.charge - from.charge);
}

}  // namespace

Battery::Battery(const BatteryConfig& config, double nominal_v)
    : config_(config),
      nominal_v_(nominal_v),
      capacity_as_(config.capacity_ah * 3600.0),
      charge_as_(config.charge * capacity_as_) {}

double Battery::OpenCircuit_v() const { return config_.always_nominal ? nominal_v_ : nominal_v_ * CurveAt(charge()); }

double Battery::Terminal_v(const MotorLoad& motor) const {
  if (config_.always_nominal) return nominal_v_;
  // V = V0 - R (load + duty * (duty V - emf) / R_motor), solved for V.
  const double share = config_.resistance_ohm / motor.resistance_ohm;
  const double terminal_v =
      (OpenCircuit_v() - config_.resistance_ohm * Load_a() + share * motor.duty * motor.back_emf_v) /
      (1.0 + share * motor.duty * motor.duty);
  return std::max(terminal_v, 0.0);  // negative: the battery cannot even supply the electronics
}

void Battery::Feed(const MotorLoad& motor, double duration_s) {
  if (config_.always_nominal) return;
  const double current_a = motor.duty * motor.Current_a(Terminal_v(motor)) + Load_a();
  charge_as_ = std::clamp(charge_as_ - current_a * duration_s, 0.0, capacity_as_);
}

}  // namespace merlin::sim
