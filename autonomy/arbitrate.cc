#include "autonomy/arbitrate.h"

#include <cmath>

#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

constexpr double kStands_m_s = 0.03;  // as the pilot: slower is standing

}  // namespace

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

double Arbiter::SpeedLimit_m_s(Time now, const ManualWish& wish, const Observation* seen) {
  if (wish.speed_m_s <= 0.0) return HUGE_VAL;
  if (seen == nullptr || Seconds(now - seen->stamp) > config_.blind_after_s) return 0.0;
  return avoid_.SpeedLimit_m_s(avoid_.FreeWay_m(*seen, ArcAhead(car_, wish.steering_rad, config_.way_m)));
}

Arbitration Arbiter::Decide(Time now, const ManualWish& wish, const std::optional<DriveCommand>& autonomy,
                            const Observation* seen) {
  const Duration valid_for = FromSeconds(config_.command_valid_s);
  const Arbitration stands{{.valid_for = valid_for}, Driver::kNobody};
  if (Seconds(now - wish.heard) > config_.silent_after_s) return stands;
  const bool finite = std::isfinite(wish.speed_m_s) && std::isfinite(wish.steering_rad);
  if (!wish.held || !finite) return wish.autonomy && autonomy ? Arbitration{*autonomy, Driver::kAutonomy} : stands;

  const double limit_m_s = SpeedLimit_m_s(now, wish, seen);
  Arbitration manual{{wish.speed_m_s, wish.steering_rad, valid_for}, Driver::kManual};
  if (wish.override_stop || wish.speed_m_s <= limit_m_s) return manual;
  manual.command.speed_m_s = limit_m_s < kStands_m_s ? 0.0 : limit_m_s;
  if (manual.command.speed_m_s == 0.0) manual.driver = Driver::kObstacleStop;
  return manual;
}

}  // namespace merlin
