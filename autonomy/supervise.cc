#include "autonomy/supervise.h"

#include <algorithm>
#include <cstdio>

namespace merlin {
namespace {

using Health = DeviceStatus::Health;

constexpr Duration kPatience = std::chrono::milliseconds(500);
constexpr double kPeriods = 3.0;

// What a device that has failed is.
const char* Word(Health health) {
  switch (health) {
    case Health::kAbsent:
      return "gone";
    case Health::kFaulty:
      return "unreadable";
    default:
      return "silent";
  }
}

std::string Tenths(Time time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", Seconds(time));
  return text;
}

}  // namespace

Duration PatienceWith(const DeviceStatus& status) {
  return status.rate_hz > 0.0 ? std::max(kPatience, FromSeconds(kPeriods / status.rate_hz)) : kPatience;
}

// What a late poll took out of a mailbox may be older than its arrival says; a status that is not ok knows better.
Time LastWell(const SupervisedDevice& device) {
  return device.status.health == Health::kOk ? device.heard : std::min(device.heard, device.status.since);
}

Health HealthOf(const SupervisedDevice& device, Time now) {
  if (now - LastWell(device) <= PatienceWith(device.status)) return Health::kOk;
  return device.status.health == Health::kOk ? Health::kSilent : device.status.health;
}

std::string Outage::Sentence(Time began) const {
  const std::string end = until == Time::max() ? " on" : " to " + Tenths(until - began);
  return "the " + device + " was " + Word(health) + " from " + Tenths(from - began) + end +
         ", and the run went on without it";
}

void Supervisor::Watch(Time now, std::span<const SupervisedDevice> devices) {
  stop_.clear();
  for (const SupervisedDevice& device : devices) {
    const Health health = HealthOf(device, now);
    if (!device.needed) Note(device, health, now);
    if (device.needed && health != Health::kOk && stop_.empty())
      stop_ = "the " + device.name + " has been " + Word(health) + " for " + Tenths(now - LastWell(device));
  }
}

void Supervisor::Note(const SupervisedDevice& device, Health health, Time now) {
  const auto last = std::find_if(outages_.rbegin(), outages_.rend(),
                                 [&](const Outage& outage) { return outage.device == device.name; });
  const bool is_out = last != outages_.rend() && last->until == Time::max();
  if (is_out && health == Health::kOk) last->until = now;
  if (!is_out && health != Health::kOk)
    outages_.push_back({.device = device.name, .health = health, .from = LastWell(device)});
}

}  // namespace merlin
