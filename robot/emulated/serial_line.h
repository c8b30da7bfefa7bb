// A serial cable: full duplex; each byte takes 10 bit times, one after the other.
#pragma once

#include <array>
#include <deque>

#include "robot/emulated/channel.h"

namespace merlin {

// One direction: bytes and when each has arrived.
class SerialWire {
 public:
  explicit SerialWire(int baud) : baud_(baud) {}
  void Put(Time now, BytesView bytes);
  Bytes Take(Time now);
  // When the last byte put so far has arrived.
  Time idle_from() const { return busy_until_; }

 private:
  struct Arrival {
    std::uint8_t byte;
    Time at;
  };
  int baud_;
  Time busy_until_{Time::min()};
  std::deque<Arrival> on_its_way_;
};

class SerialLine : public Channel {
 public:
  explicit SerialLine(int baud) : from_{SerialWire(baud), SerialWire(baud)} {}
  void Put(Side from, Time now, BytesView bytes) override { from_[static_cast<std::size_t>(from)].Put(now, bytes); }
  Bytes Take(Side at, Time now) override { return from_[static_cast<std::size_t>(Other(at))].Take(now); }

 private:
  std::array<SerialWire, 2> from_;
};

}  // namespace merlin
