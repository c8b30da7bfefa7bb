#include "scenarios/run/car_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world/room_box.h"

namespace merlin {
namespace {

constexpr Duration kAirborne = std::chrono::milliseconds(500);
constexpr double kTilt_rad = std::numbers::pi / 4.0;
constexpr double kSunk_m = 0.5;
constexpr double kOutside_m = 1.0;

}  // namespace

CarWatch::CarWatch(const sim::World& world, bool on_turntable)
    : on_turntable_(on_turntable),
      start_z_m_(world.T_world_base().translation().z()),
      room_m_(sim::RoomBox_m(world)),
      on_ground_(world.Now()) {}

void CarWatch::Watch(const sim::World& world) {
  if (!lost_.empty()) return;
  if (on_turntable_ || world.WheelTouchesGround()) on_ground_ = world.Now();
  if (const std::string reason = Reason(world); !reason.empty())
    lost_ = fmt::format("at {:.3f} s {}", Seconds(world.Now()), reason);
}

std::string CarWatch::Reason(const sim::World& world) const {
  const Pose T_world_base = world.T_world_base();
  const Eigen::Vector3d p = T_world_base.translation();
  const double tilt_rad = std::acos(std::clamp(T_world_base.linear()(2, 2), -1.0, 1.0));
  const double sunk_m = start_z_m_ - p.z();
  if (world.Now() - on_ground_ > kAirborne) return "no wheel of the car had touched the ground for 0.5 s";
  if (tilt_rad > kTilt_rad)
    return fmt::format("the car tilted by {:.1f} deg: more than 45 deg", tilt_rad * 180.0 / std::numbers::pi);
  if (sunk_m > kSunk_m) return fmt::format("the car was {:.3f} m below its start: more than 0.5 m", sunk_m);
  if (room_m_ && ((p.head<2>() - room_m_->max()).maxCoeff() > kOutside_m ||
                  (room_m_->min() - p.head<2>()).maxCoeff() > kOutside_m))
    return fmt::format(
        "the car left the room: it was at x {:.2f} m, y {:.2f} m, more than 1 m outside x {:.2f} to {:.2f} m, y {:.2f} "
        "to {:.2f} m",
        p.x(), p.y(), room_m_->min().x(), room_m_->max().x(), room_m_->min().y(), room_m_->max().y());
  return "";
}

}  // namespace merlin
