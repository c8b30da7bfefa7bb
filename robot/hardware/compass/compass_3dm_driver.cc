#include "robot/hardware/compass/compass_3dm_driver.h"

#include <mutex>

namespace merlin {

struct Compass3dmDriver::Impl {
  Impl(const Compass3dmConfig& config, const Clock& clock) : host(config), thread(config.serial, clock, host, mutex) {}

  std::mutex mutex;
  Compass3dmHost host;
  SerialThread thread;  // last: it uses the others
};

Compass3dmDriver::Compass3dmDriver(const Compass3dmConfig& config, const Clock& clock)
    : impl_(std::make_unique<Impl>(config, clock)) {}

Compass3dmDriver::~Compass3dmDriver() = default;

std::optional<CompassReading> Compass3dmDriver::Poll() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->host.readings.Take();
}

DeviceStatus Compass3dmDriver::Status() const {
  const std::lock_guard lock(impl_->mutex);
  return WithRate(impl_->host.readings.Counted(impl_->host.status()), impl_->host.rate_hz());
}

std::string Compass3dmDriver::Complaint() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->host.Complaint();
}

}  // namespace merlin
