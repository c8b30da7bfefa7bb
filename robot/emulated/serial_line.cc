#include "robot/emulated/serial_line.h"

#include <algorithm>

#include "robot/protocol/serial_end.h"

namespace merlin {

void SerialWire::Put(Time now, BytesView bytes) {
  const Time start = std::max(now, busy_until_);
  // Computed from the count, not byte by byte, so that rounding errors do not add up.
  for (std::size_t i = 0; i < bytes.size(); ++i) on_its_way_.push_back({bytes[i], start + WireTime(i + 1, baud_)});
  if (!bytes.empty()) busy_until_ = on_its_way_.back().at;
}

Bytes SerialWire::Take(Time now) {
  Bytes arrived;
  while (!on_its_way_.empty() && on_its_way_.front().at <= now) {
    arrived.push_back(on_its_way_.front().byte);
    on_its_way_.pop_front();
  }
  return arrived;
}

}  // namespace merlin
