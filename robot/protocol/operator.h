// What the operator's station says to the car over the radio: the command in one byte (robot/protocol/one_byte.h) and
// his switches, in a frame of robot/protocol/frame.h. Ours: the thesis says of the station no more than that a joystick
// drives the car by radio.
#pragma once

#include <cstdint>
#include <optional>

#include "robot/protocol/frame.h"

namespace merlin::operator_link {

struct Message {
  std::uint8_t command = 0;    // one byte: speed and steering
  bool held = false;           // the hand is on the stick
  bool override_stop = false;  // drive on, whatever is in the way
  bool autonomy = false;       // the pilot may drive while the hand is off
  bool operator==(const Message&) const = default;
};

Bytes Encode(const Message& message, std::uint8_t sequence);

class Decoder {
 public:
  // The newest message among what has come, if any. Frames of other types and sizes are thrown away and counted.
  std::optional<Message> Feed(BytesView bytes);
  const LinkCounters& counters() const { return frames_.counters(); }

 private:
  FrameDecoder frames_;
};

}  // namespace merlin::operator_link
