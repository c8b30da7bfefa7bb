// One end of a serial line as a state machine: times and bytes in, bytes out. It knows no port and no clock, so that a
// test can run host and device through an hour of faults in a moment. It is the one interface beside the HAL: the same
// thread serves every driver, and the same pump every emulated device.
#pragma once

#include "robot/protocol/bytes.h"
#include "robot/types/time.h"

namespace merlin {

class SerialEnd {
 public:
  virtual ~SerialEnd() = default;
  // What has come since the last call; may be nothing.
  virtual void Receive(Time now, BytesView bytes) = 0;
  // What goes out now. Call when next() has come, and after Receive.
  virtual Bytes Send(Time now) = 0;
  virtual Time next() const = 0;
};

// How long a number of bytes takes: a start bit, 8 bits, a stop bit each.
inline Duration WireTime(std::size_t bytes, int baud) { return FromSeconds(10.0 * static_cast<double>(bytes) / baud); }

}  // namespace merlin
