#include "scenarios/run/hear.h"

#include <algorithm>
#include <utility>

namespace merlin {

Ears::Ears(const Robot& robot) : robot_(robot) {
  const auto add = [&](const char* name, bool needed, bool exists) {
    if (exists) devices_.push_back({.name = name, .needed = needed, .status = {}, .heard = robot.clock->Now()});
  };
  add("depth camera", true, robot.depth != nullptr);
  add("drive", true, robot.drive != nullptr);
  add("colour camera", false, robot.color != nullptr);
  add("compass", false, robot.compass != nullptr);
  add("pan unit", false, robot.pan != nullptr);
  add("turntable", false, robot.turntable != nullptr);
}

const SupervisedDevice& Ears::Of(const std::string& name) const {
  return *std::ranges::find(devices_, name, &SupervisedDevice::name);
}

template <class Device, class Take>
void Ears::Poll(const std::string& name, Device* device, const Take& take) {
  if (device == nullptr) return;
  SupervisedDevice& known = *std::ranges::find(devices_, name, &SupervisedDevice::name);
  while (auto measurement = UseDevice(name, [&] { return device->Poll(); })) {
    known.heard = robot_.clock->Now();
    take(*std::move(measurement));
  }
  known.status = UseDevice(name, [&] { return device->Status(); });
}

void Ears::Hear(LoopState::Heard& heard) {
  Poll("drive", robot_.drive, [&](const DriveState& state) { heard.drive.push_back(state); });
  Poll("pan unit", robot_.pan, [&](const PanState& state) { heard.pan.push_back(state); });
  Poll("turntable", robot_.turntable, [&](const PanState& state) { heard.turntable.push_back(state); });
  Poll("compass", robot_.compass, [&](const CompassReading& reading) { heard.compass.push_back(reading); });
  Poll("colour camera", robot_.color,
       [&](ColorFrame&& frame) { heard.color.push_back(std::make_shared<const ColorFrame>(std::move(frame))); });
  Poll("depth camera", robot_.depth,
       [&](DepthFrame&& frame) { heard.depth.push_back(std::make_shared<const DepthFrame>(std::move(frame))); });
}

}  // namespace merlin
