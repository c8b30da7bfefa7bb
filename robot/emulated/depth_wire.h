// The messages between the twin and its vendor library (pmd_library.cc) over a local socket. The format is ours. Both
// ends run on the same machine; numbers are little-endian.
//
//   header, 12 bytes: 'M' 'P' 'M' 'D', u16 version (1), u16 kind, u32 bytes of payload
//   hello   1, server  u16 columns, u16 rows, u32 shortest and longest integration [us], u32 count,
//                      count x u32 frequency [Hz], settings (as in set), 8 x f64: fx fy cx cy k1 k2 p1 p2
//   update  2, client  asks for the next frame
//   frame   3, server  u16 columns, u16 rows, u64 stamp [ns], settings; then images: f32 range [m], f32 amplitude [e],
//                      u8 intensity, u8 flags
//   set     4, client  settings: u32 integration [us], u32 first, u32 second frequency [Hz]
//   done    5, server  the settings hold from the next exposure on
//   refused 6, server  why not: text of at most 256 bytes
//
// No message is longer than a frame of the largest picture. Anything else is garbage, and then the connection is
// closed: a socket loses no bytes, so the stream cannot be in step again after an error.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "robot/types/camera_model.h"

namespace merlin {

struct WireSettings {
  std::uint32_t integration_us = 0;
  std::uint32_t frequency_hz = 0;
  std::uint32_t second_frequency_hz = 0;  // 0: none

  bool operator==(const WireSettings&) const = default;
};

struct WireHello {
  CameraModel camera;
  std::uint32_t integration_min_us = 0;
  std::uint32_t integration_max_us = 0;
  std::vector<std::uint32_t> frequencies_hz;
  WireSettings settings;
};
struct WireUpdate {};
struct WireFrame {
  std::uint16_t columns = 0;
  std::uint16_t rows = 0;
  std::uint64_t stamp_ns = 0;
  WireSettings settings;
  std::vector<float> range_m, amplitude;
  std::vector<std::uint8_t> intensity, flags;
};
struct WireSet {
  WireSettings settings;
};
struct WireDone {};
struct WireRefused {
  std::string why;
};
// In the order of the kinds' numbers on the wire.
using WireMessage = std::variant<WireHello, WireUpdate, WireFrame, WireSet, WireDone, WireRefused>;

// Empty if there is no message, or it is of another type.
template <class Message>
std::optional<Message> As(std::optional<WireMessage> message) {
  if (!message || !std::holds_alternative<Message>(*message)) return std::nullopt;
  return std::get<Message>(std::move(*message));
}

std::vector<std::uint8_t> Encode(const WireMessage& message);

// The message at the beginning of a stream of bytes.
struct WireReading {
  enum class Kind { kPartial, kMessage, kGarbage };
  Kind kind = Kind::kPartial;
  std::size_t bytes = 0;  // of the message
  std::optional<WireMessage> message;
};
WireReading Decode(std::span<const std::uint8_t> bytes);

}  // namespace merlin
