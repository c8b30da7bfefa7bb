// What the twin and its vendor library (pmd_library.cc) say to each other over a local socket: messages of our own, the
// same machine at both ends, little-endian.
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
// A reader never asks for more than a frame of the largest picture; what is none of these is garbage, and the
// connection is given up: the socket loses no bytes, so there is nothing to find again in what follows.
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
// In the order of their numbers on the wire.
using WireMessage = std::variant<WireHello, WireUpdate, WireFrame, WireSet, WireDone, WireRefused>;

// None where it is another message, or none.
template <class Message>
std::optional<Message> As(std::optional<WireMessage> message) {
  if (!message || !std::holds_alternative<Message>(*message)) return std::nullopt;
  return std::get<Message>(std::move(*message));
}

std::vector<std::uint8_t> Encode(const WireMessage& message);

// What a stream of bytes begins with.
struct WireReading {
  enum class Kind { kPartial, kMessage, kGarbage };
  Kind kind = Kind::kPartial;
  std::size_t bytes = 0;  // of the message
  std::optional<WireMessage> message;
};
WireReading Decode(std::span<const std::uint8_t> bytes);

}  // namespace merlin
