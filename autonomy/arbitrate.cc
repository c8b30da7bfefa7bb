#include "autonomy/arbitrate.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr double kPathStep_m = 0.05;
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

std::vector<Eigen::Vector2d> ArcAhead(const CarDescription& car, double steering_rad, double length_m) {
  const double wheels_rad = std::clamp(steering_rad, -car.steering_max_rad, car.steering_max_rad);
  const Pose step = FromXyYaw(kPathStep_m, 0.0, kPathStep_m * std::tan(wheels_rad) / car.wheelbase_m);
  std::vector<Eigen::Vector2d> way_base;
  Pose T_base_ahead = Pose::Identity();
  for (double s = 0.0; s <= length_m; s += kPathStep_m) {
    way_base.push_back(T_base_ahead.translation().head<2>());
    T_base_ahead = T_base_ahead * step;
  }
  return way_base;
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
  // The servo is told what it will report, the wheels do what is meant.
  Arbitration manual{{wish.speed_m_s, wish.steering_rad - car_.steering_offset_rad, valid_for}, Driver::kManual};
  if (wish.override_stop || wish.speed_m_s <= limit_m_s) return manual;
  manual.command.speed_m_s = limit_m_s < kStands_m_s ? 0.0 : limit_m_s;
  if (manual.command.speed_m_s == 0.0) manual.driver = Driver::kObstacleStop;
  return manual;
}

}  // namespace merlin
