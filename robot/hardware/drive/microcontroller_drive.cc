#include "robot/hardware/drive/microcontroller_drive.h"

#include <mutex>

namespace merlin {

struct MicrocontrollerDrive::Impl : PanUnit {
  Impl(const MicrocontrollerConfig& config, const Clock& its_clock)
      : clock(its_clock), host(config), thread(config.serial, its_clock, host, mutex) {}

  void Command(const DriveCommand& command) {
    {
      const std::lock_guard lock(mutex);
      host.Command(command, clock.Now());
    }
    thread.Wake();
  }

  void Send(double angle_rad) override {
    {
      const std::lock_guard lock(mutex);
      host.Pan(angle_rad);
    }
    thread.Wake();
  }
  std::optional<PanState> Poll() override {
    const std::lock_guard lock(mutex);
    return host.pan_states.Take();
  }
  DeviceStatus Status() const override {
    const std::lock_guard lock(mutex);
    DeviceStatus status = WithRate(host.pan_states.Counted(host.status()), microcontroller::kStateRate_hz);
    if (!host.has_pan()) status.health = DeviceStatus::Health::kAbsent;
    return status;
  }

  const Clock& clock;
  mutable std::mutex mutex;
  MicrocontrollerHost host;
  SerialThread thread;  // last: it uses the others
};

MicrocontrollerDrive::MicrocontrollerDrive(const MicrocontrollerConfig& config, const Clock& clock)
    : impl_(std::make_unique<Impl>(config, clock)) {}

MicrocontrollerDrive::~MicrocontrollerDrive() { impl_->Command({}); }

void MicrocontrollerDrive::Send(const DriveCommand& command) { impl_->Command(command); }

std::optional<DriveState> MicrocontrollerDrive::Poll() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->host.states.Take();
}

DeviceStatus MicrocontrollerDrive::Status() const {
  const std::lock_guard lock(impl_->mutex);
  return WithRate(impl_->host.states.Counted(impl_->host.status()), microcontroller::kStateRate_hz);
}

PanUnit& MicrocontrollerDrive::pan() { return *impl_; }

std::string MicrocontrollerDrive::firmware() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->host.firmware();
}

std::string MicrocontrollerDrive::Complaint() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->host.Complaint();
}

}  // namespace merlin
