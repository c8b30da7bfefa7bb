#include "robot/hardware/serial/serial_thread.h"

#include <algorithm>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr Duration kReopenPeriod = std::chrono::milliseconds(200);
constexpr Duration kLongestWait = std::chrono::milliseconds(20);  // health is judged at least as often
constexpr Duration kFarewell = std::chrono::milliseconds(50);     // the end sends nothing that is due later than this

}  // namespace

SerialThread::SerialThread(const SerialConfig& config, const Clock& clock, HostEnd& end, std::mutex& mutex)
    : clock_(clock), end_(end), mutex_(mutex), port_(config) {
  port_.Open();
  end_.Connected(clock_.Now());
  thread_ = std::thread([this] { Run(); });
}

SerialThread::~SerialThread() {
  stop_ = true;
  port_.Wake();
  thread_.join();
}

void SerialThread::Run() {
  while (!stop_) {
    Step();
    port_.Wait(port_.is_open() ? std::min(Next() - clock_.Now(), kLongestWait) : kLongestWait);
  }
  const Duration wait = Next() - clock_.Now();
  if (wait > kFarewell) return;
  std::this_thread::sleep_for(wait);
  Step();
}

Time SerialThread::Next() {
  const std::lock_guard lock(mutex_);
  return end_.next();
}

void SerialThread::Step() {
  const Time now = clock_.Now();
  if (!port_.is_open() && !Reopen(now)) return;
  const Bytes received = port_.Read();
  Bytes sent;
  {
    const std::lock_guard lock(mutex_);
    end_.Receive(now, received);
    sent = end_.Send(now);
  }
  port_.Write(sent);
  if (port_.is_open()) return;
  const std::lock_guard lock(mutex_);
  end_.Disconnected(now);
}

bool SerialThread::Reopen(Time now) {
  if (now < reopen_) return false;
  reopen_ = now + kReopenPeriod;
  try {
    port_.Open();
  } catch (const MachineError&) {
    return false;  // the port is still missing, which the device's status shows
  }
  const std::lock_guard lock(mutex_);
  end_.Connected(now);
  return true;
}

}  // namespace merlin
