// Joystick events of Linux' joydev (Documentation/input/joydev/joystick-api.rst, struct js_event), 8 bytes each: time
// in ms (u32), value (s16), type (u8: 1 button, 2 axis, 0x80 more for the state at opening), number (u8). They come
// from this machine's kernel, hence in its byte order: little-endian on all that we run on.
#pragma once

#include <array>
#include <cstdint>

#include "robot/protocol/bytes.h"

namespace merlin::joystick {

inline constexpr std::size_t kEvent_bytes = 8;
inline constexpr std::size_t kMax = 32;  // axes, and buttons; events of higher numbers are thrown away

struct State {
  std::array<double, kMax> axes{};  // -1 (left, ahead) to 1 (right, back), 0: at rest or not there
  std::array<bool, kMax> buttons{};
  std::uint32_t time_ms = 0;  // of the last event
};

class Decoder {
 public:
  // What one read of the device gave. It gives whole events, so that each read starts anew: an incomplete event at its
  // end is thrown away.
  void Feed(BytesView read);
  const State& state() const { return state_; }
  std::uint64_t garbage_bytes() const { return garbage_bytes_; }

 private:
  bool Take(BytesView event);

  State state_;
  std::uint64_t garbage_bytes_ = 0;
};

}  // namespace merlin::joystick
