// The attitude sensor MicroStrain 3DM on a serial port, polled by a thread of its own.
#pragma once

#include <memory>
#include <string>

#include "robot/hal/clock.h"
#include "robot/hal/compass.h"
#include "robot/hardware/compass/compass_3dm_host.h"

namespace merlin {

class Compass3dmDriver : public Compass {
 public:
  // Throws MachineError if the port cannot be opened. The clock must outlive this object and be callable from any
  // thread.
  Compass3dmDriver(const Compass3dmConfig& config, const Clock& clock);
  ~Compass3dmDriver() override;

  std::optional<CompassReading> Poll() override;
  DeviceStatus Status() const override;
  std::string Complaint() const;  // what is wrong, one sentence; empty if nothing is

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace merlin
