#include "perception/odometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

void Heading::Update(Time stamp, double compass_yaw_rad, double odometry_yaw_rad) {
  const double measured_variance = config_.compass_sigma_rad * config_.compass_sigma_rad;
  const double offset_rad = WrapPi(compass_yaw_rad - odometry_yaw_rad);
  if (!started_) {
    started_ = true;
    offset_rad_ = offset_rad;
    variance_ = measured_variance;
  } else {
    variance_ = VarianceAt(stamp, odometry_yaw_rad);
    const double difference_rad = WrapPi(offset_rad - offset_rad_);
    if (!IsBent(stamp, difference_rad, measured_variance)) {
      const double gain = variance_ / (variance_ + measured_variance);
      offset_rad_ = WrapPi(offset_rad_ + gain * difference_rad);
      variance_ *= 1.0 - gain;
    }
  }
  stamp_ = stamp;
  odometry_yaw_rad_ = odometry_yaw_rad;
}

// Exponential average of the differences and its variance, were they noise: measured over their number, and the
// filter's own.
bool Heading::IsBent(Time stamp, double difference_rad, double measured_variance) {
  const double share = 1.0 - std::exp(-std::max(0.0, Seconds(stamp - stamp_)) / config_.bend_memory_s);
  difference_rad_ += share * (difference_rad - difference_rad_);
  averaged_ = share * share + (1.0 - share) * (1.0 - share) * averaged_;
  const double sigma_rad = std::sqrt(averaged_ * measured_variance + variance_);
  if (std::abs(difference_rad_) <= config_.bend_sigmas * sigma_rad) {
    bent_since_.reset();
    return false;
  }
  if (!bent_since_) bent_since_ = stamp;
  return Seconds(stamp - *bent_since_) < config_.bend_wait_s;
}

double Heading::VarianceAt(Time now, double odometry_yaw_rad) const {
  const double turned_rad = WrapPi(odometry_yaw_rad - odometry_yaw_rad_);
  return variance_ + std::pow(config_.drift_per_turn * turned_rad, 2) +
         std::pow(config_.drift_rad_per_sqrt_s, 2) * std::max(0.0, Seconds(now - stamp_));
}

double Heading::Sigma_rad(Time now, double odometry_yaw_rad) const {
  return started_ ? std::sqrt(VarianceAt(now, odometry_yaw_rad)) : std::numeric_limits<double>::infinity();
}

}  // namespace merlin
