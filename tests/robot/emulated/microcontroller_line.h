// Both ends of the microcontroller's line, host (the shipped driver without its thread) and emulator, joined by a cable
// with its timing and by faults. Time and bytes are injected: nothing sleeps.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "robot/emulated/microcontroller_emulator.h"
#include "robot/emulated/serial_line.h"
#include "robot/hardware/drive/microcontroller_host.h"

namespace merlin {

// What a fault makes of the bytes that an end has just sent.
using LineFault = std::function<Bytes(Time now, Side from, const Bytes& sent)>;

// Car: Step(now), Wired(), braked().
template <class Car>
class MicrocontrollerLine {
 public:
  static constexpr int kBaud = 57600;
  static constexpr Duration kTick = std::chrono::milliseconds(1);

  explicit MicrocontrollerLine(std::unique_ptr<Channel> channel = std::make_unique<SerialLine>(kBaud),
                               Time start = Time(0))
      : now(start), channel_(std::move(channel)) {
    car.Step(now);
    SwitchOn();
    host.Connected(now);
  }

  // The stack renews the command every 50 ms, if it has one.
  void Run(Duration duration, const std::optional<DriveCommand>& command = std::nullopt) {
    for (const Time end = now + duration; now < end; now += kTick) {
      car.Step(now);
      if (command && now % std::chrono::milliseconds(50) == Duration(0)) host.Command(*command, now - host_started);
      host.Receive(now - host_started, channel_->Take(Side::kHost, now));
      Put(Side::kHost, host.Send(now - host_started));
      micro->Receive(now, channel_->Take(Side::kDevice, now));
      Put(Side::kDevice, micro->Send(now));
      while (const auto state = host.states.Take()) states.push_back(*state);
      if (!car.braked()) last_driven = now;
    }
  }
  void SwitchOn() {
    micro = std::make_unique<MicrocontrollerEmulator>(MicrocontrollerEmulatorConfig{}, car.Wired(), now);
  }

  Time now, last_driven{0}, host_started{0};
  Car car;
  MicrocontrollerHost host{MicrocontrollerConfig{.serial = {.port = "line", .baud = kBaud}}};
  std::unique_ptr<MicrocontrollerEmulator> micro;
  std::vector<DriveState> states;
  LineFault fault;

 private:
  void Put(Side from, const Bytes& sent) { channel_->Put(from, now, fault ? fault(now, from, sent) : sent); }
  std::unique_ptr<Channel> channel_;
};

inline LineFault Silence() {
  return [](Time, Side, const Bytes&) { return Bytes(); };
}

inline LineFault Garbage() {
  return [random = std::mt19937(1)](Time, Side, Bytes sent) mutable {
    for (std::uint8_t& byte : sent) byte = static_cast<std::uint8_t>(random());
    return sent;
  };
}

inline LineFault Halves() {
  return [](Time, Side, const Bytes& sent) {
    return Bytes(sent.begin(), sent.begin() + static_cast<std::ptrdiff_t>(sent.size() / 2));
  };
}

// Repeats the host's last frame again and again, like a stuck buffer.
inline LineFault Duplicates() {
  return [last = Bytes(), repeat = Time(0)](Time now, Side from, const Bytes& sent) mutable {
    if (from == Side::kDevice) return sent;
    if (last.empty()) last = sent;
    if (last.empty() || now < repeat) return Bytes();
    repeat = now + std::chrono::milliseconds(20);
    return last;
  };
}

// Delays what the host sends by this time.
inline LineFault Late(Duration by) {
  return [by, held = std::deque<std::pair<Time, Bytes>>()](Time now, Side from, const Bytes& sent) mutable {
    if (from == Side::kDevice) return sent;
    held.emplace_back(now + by, sent);
    Bytes due;
    while (!held.empty() && held.front().first <= now) {
      due.insert(due.end(), held.front().second.begin(), held.front().second.end());
      held.pop_front();
    }
    return due;
  };
}

}  // namespace merlin
