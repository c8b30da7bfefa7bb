// What follows from the state of the devices. This is the one place that reads their statuses and decides; everybody
// else reads the result.
//
//   depth camera, drive                           failed: the car stops, and the run ends
//   colour camera, compass, pan unit, turntable   failed: a warning; the stack goes on without it
//
// A device has failed when for 0.5 s, or for three of its periods if that is longer, nothing has come from it, or its own
// status has not been ok. A hiccup shorter than that is forgiven: a driver reopens its camera by itself.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "robot/types/device_status.h"

namespace merlin {

// What the loop knows of a device in one tick.
struct SupervisedDevice {
  std::string name;     // "depth camera"
  bool needed = false;  // the car must not drive without it
  DeviceStatus status;
  Time heard{0};  // when its newest measurement arrived; before the first: when the run began
};

// How long a device may fail to measure: 0.5 s or three periods. Only 0.5 s where its rate is not known (0).
Duration PatienceWith(const DeviceStatus& status);

// When the device was last well: when it was last heard, or when its status turned bad.
Time LastWell(const SupervisedDevice& device);

// How the device is, its silence taken into account. kOk: it has not failed.
DeviceStatus::Health HealthOf(const SupervisedDevice& device, Time now);

// A time during which the run did without a device.
struct Outage {
  std::string device;
  DeviceStatus::Health health;  // not kOk
  Time from{0};                 // when the device was last well
  Time until = Time::max();     // when it was back; max: it is still out

  // "the compass was silent from 4.2 s to 6.0 s, and the run went on without it": counted from when the run began.
  std::string Sentence(Time began = Time(0)) const;
};

class Supervisor {
 public:
  // At every tick, after the devices were polled, with the same devices in the same order.
  void Watch(Time now, std::span<const SupervisedDevice> devices);

  // Why the car must stop: a sentence that names the first needed device that has failed. Empty: drive on.
  const std::string& stop() const { return stop_; }
  // Of devices the run can do without, since its start, in the order in which they were noticed.
  const std::vector<Outage>& outages() const { return outages_; }

 private:
  void Note(const SupervisedDevice& device, DeviceStatus::Health health, Time now);

  std::string stop_;
  std::vector<Outage> outages_;
};

}  // namespace merlin
