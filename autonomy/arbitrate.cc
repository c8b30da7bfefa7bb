#include "autonomy/arbitrate.h"

#include <cmath>

#include "robot/kinematics/motion.h"

namespace merlin {

const char* Name(Driver driver) {
  switch (driver) {
    case Driver::kManual:
      return "manual";
    case Driver::kAutonomy:
      return "autonomy";
    case Driver::kObstacleStop:
      return "obstacle stop";
    default:
      return "nobody";
  }
}

double Arbiter::SpeedLimit_m_s(Time now, const ManualCommand& manual, const Observation* seen) {
  if (manual.speed_m_s <= 0.0) return HUGE_VAL;
  if (seen == nullptr || Seconds(now - seen->stamp) > config_.blind_after_s) return 0.0;
  const auto arc_base = ArcAhead(car_, manual.steering_rad, config_.watched_m);
  return avoid_.SpeedLimit_m_s(avoid_.FreeDistance_m(*seen, arc_base));
}

Arbitration Arbiter::Decide(Time now, const ManualCommand& manual, const std::optional<DriveCommand>& autonomy,
                            const Observation* seen) {
  const Duration valid_for = FromSeconds(config_.command_valid_s);
  const Arbitration halt{{.valid_for = valid_for}, Driver::kNobody};
  if (Seconds(now - manual.heard) > config_.silent_after_s) return halt;
  const bool finite = std::isfinite(manual.speed_m_s) && std::isfinite(manual.steering_rad);
  if (!manual.held || !finite) return manual.autonomy && autonomy ? Arbitration{*autonomy, Driver::kAutonomy} : halt;

  const double limit_m_s = SpeedLimit_m_s(now, manual, seen);
  Arbitration driven{{manual.speed_m_s, manual.steering_rad, valid_for}, Driver::kManual};
  if (manual.override_stop || manual.speed_m_s <= limit_m_s) return driven;
  driven.command.speed_m_s = limit_m_s < kCreep_m_s ? 0.0 : limit_m_s;
  if (driven.command.speed_m_s == 0.0) driven.driver = Driver::kObstacleStop;
  return driven;
}

}  // namespace merlin
