#include "perception/odometry.h"

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

constexpr Duration kHistory = std::chrono::seconds(1);

// sin(a) / a and (1 - cos(a)) / a, by series near zero.
struct ArcShape {
  double along, across;
};

ArcShape ShapeOf(double a) {
  if (std::abs(a) < 1e-3) return {1.0 - a * a / 6.0, 0.5 * a};
  const double s = std::sin(a), c = std::cos(a);
  return {s / a, (1.0 - c) / a};
}

// Exact motion on a circle: path along the rear axle, turned angle.
Pose ArcMotion(double path_m, double turn_rad) {
  const ArcShape shape = ShapeOf(turn_rad);
  return FromXyYaw(path_m * shape.along, path_m * shape.across, turn_rad);
}

}  // namespace

double WheelMeanRatio(double wheelbase_m, double track_m, double steering_rad) {
  // In units of the rear axle's radius R = L / tan(steering): half track t, wheelbase l. The rear wheels' mean is 1.
  const double curvature_1_m = std::tan(std::abs(steering_rad)) / wheelbase_m;
  const double t = 0.5 * track_m * curvature_1_m;
  const double l = wheelbase_m * curvature_1_m;
  return 0.5 + 0.25 * (std::hypot(1.0 - t, l) + std::hypot(1.0 + t, l));
}

Odometry::Odometry(const CarDescription& car)
    : wheelbase_m_(car.wheelbase_m),
      track_m_(car.track_m),
      metres_per_count_(car.MetresPerCount()),
      steering_offset_rad_(car.steering_offset_rad) {}

void Odometry::Update(const DriveState& state) {
  Pose T_odom_base = knots_.empty() ? Pose::Identity() : knots_.back().T_odom_base;
  if (last_) {
    const double steering_rad = 0.5 * (last_->steering_rad + state.steering_rad) + steering_offset_rad_;
    const double wheels_m = metres_per_count_ * static_cast<double>(state.encoder_counts - last_->encoder_counts);
    const double path_m = wheels_m / WheelMeanRatio(wheelbase_m_, track_m_, steering_rad);
    T_odom_base = T_odom_base * ArcMotion(path_m, path_m * std::tan(steering_rad) / wheelbase_m_);
  }
  last_ = state;
  knots_.push_back({state.stamp, T_odom_base});
  while (knots_.front().stamp + kHistory < state.stamp) knots_.pop_front();
}

std::optional<Pose> Odometry::At(Time time) const {
  if (knots_.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(knots_.begin(), knots_.end(), time, [](const Knot& knot, Time t) { return knot.stamp < t; });
  if (after == knots_.begin()) return knots_.front().T_odom_base;
  if (after == knots_.end()) return knots_.back().T_odom_base;
  const auto before = std::prev(after);
  return Interpolate(before->T_odom_base, after->T_odom_base,
                     Seconds(time - before->stamp) / Seconds(after->stamp - before->stamp));
}

}  // namespace merlin
