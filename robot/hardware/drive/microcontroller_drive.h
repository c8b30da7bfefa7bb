// The driver of MERLIN's motor, steering and (where there is one) pan unit: its microcontroller on a serial port. The
// driver has its own thread; no call waits for the port. Braking never depends on this program: the microcontroller
// brakes when a command expires and when none comes.
#pragma once

#include <memory>
#include <string>

#include "robot/hal/clock.h"
#include "robot/hal/drive.h"
#include "robot/hal/pan_unit.h"
#include "robot/hardware/drive/microcontroller_host.h"

namespace merlin {

class MicrocontrollerDrive : public Drive {
 public:
  // Throws MachineError if the port cannot be opened. The clock must outlive this object and be callable from any
  // thread.
  MicrocontrollerDrive(const MicrocontrollerConfig& config, const Clock& clock);
  // Stops the car.
  ~MicrocontrollerDrive() override;

  void Send(const DriveCommand& command) override;
  std::optional<DriveState> Poll() override;
  DeviceStatus Status() const override;

  // Absent as long as the microcontroller reports none.
  PanUnit& pan();

  std::string firmware() const;   // empty until the microcontroller has reported it
  std::string Complaint() const;  // what is wrong, one sentence; empty if nothing is

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin
