#include "perception/odometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/motion.h"

namespace merlin {
namespace {

constexpr Duration kHistory = std::chrono::seconds(1);

}  // namespace

void Odometry::Update(const DriveState& state) {
  Pose T_odom_base = knots_.empty() ? Pose::Identity() : knots_.back().T_odom_base;
  if (last_) {
    const double wheels_rad = WheelsAngle_rad(car_, 0.5 * (last_->steering_rad + state.steering_rad));
    const double path_m = Path_m(car_, state.encoder_counts - last_->encoder_counts, wheels_rad);
    T_odom_base = T_odom_base * ArcMotion(path_m, Turn_rad(car_, path_m, wheels_rad));
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

// Exponential average of the differences and its variance, were they noise: measured over their number, and the filter's own.
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
