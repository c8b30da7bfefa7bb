// The message of the operator's station to the car over the radio: the manual command in one byte
// (robot/protocol/one_byte.h) and the switches, in a frame of robot/protocol/frame.h. The message is ours: the thesis
// (robot/protocol/one_byte.h) says of the station only that a joystick drives the car by radio.
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include <cstdint>
#include <optional>

#include "robot/protocol/frame.h"

namespace merlin::operator_link {

struct Message {
  std::uint8_t command = 0;    // one byte: speed and steering
  bool held = false;           // the operator holds the stick
  bool override_stop = false;  // drive on, even towards an obstacle
  bool autonomy = false;       // the pilot may drive while the operator does not hold it
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
