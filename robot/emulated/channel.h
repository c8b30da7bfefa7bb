// The link between host and device, a cable or a radio: bytes go in at one end and come out at the other after a delay.
#pragma once

#include "robot/protocol/bytes.h"
#include "robot/types/time.h"

namespace merlin {

enum class Side : std::size_t { kHost = 0, kDevice = 1 };
inline Side Other(Side side) { return side == Side::kHost ? Side::kDevice : Side::kHost; }

// Times never go back.
class Channel {
 public:
  virtual ~Channel() = default;
  virtual void Put(Side from, Time now, BytesView bytes) = 0;
  // The bytes that have arrived by now.
  virtual Bytes Take(Side at, Time now) = 0;
};

}  // namespace merlin
