#include "robot/emulated/serial_pump.h"

#include <utility>

namespace merlin {

SerialPump::SerialPump(PseudoTerminal& terminal, std::unique_ptr<Channel> channel, SerialEnd& device, int baud)
    : terminal_(terminal), channel_(std::move(channel)), device_(device), baud_(baud) {}

void SerialPump::Step(Time now) {
  channel_->Put(Side::kHost, now, AsHeard(terminal_.Read()));
  device_.Receive(now, channel_->Take(Side::kDevice, now));
  channel_->Put(Side::kDevice, now, device_.Send(now));
  terminal_.Write(AsHeard(channel_->Take(Side::kHost, now)));
}

// A receiver at another rate samples the bits at wrong times. What it reads depends on the bits sent, but differs from
// them.
Bytes SerialPump::AsHeard(Bytes bytes) const {
  if (terminal_.baud() == baud_) return bytes;
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>((byte << 3 | byte >> 1) ^ 0xA5);
  return bytes;
}

}  // namespace merlin
