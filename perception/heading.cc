#include "perception/heading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace merlin {

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

// Compares the exponential average of the differences with the sigma that it would have if they were noise.
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
