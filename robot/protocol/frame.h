// The frames between PC and microcontroller, over a serial line or the radio, whose packets they fit (96 bytes).
// On the wire: 0x00, COBS(version, type, sequence number, payload, CRC-16 of all before it, big-endian), 0x00.
// The zero in front closes whatever garbage came before, so that it never costs a good frame.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/protocol/bytes.h"

namespace merlin {

inline constexpr std::uint8_t kProtocolVersion = 1;
inline constexpr std::size_t kFrameMax_bytes = 96;    // on the wire, delimiters included
inline constexpr std::size_t kPayloadMax_bytes = 88;  // less 2 delimiters, 1 of COBS, 3 of head, 2 of CRC

struct Frame {
  std::uint8_t type = 0;
  std::uint8_t sequence = 0;  // counts the sender's frames, modulo 256
  Bytes payload{};            // at most kPayloadMax_bytes
};

// Types with this value, the direction bit 0x80 apart, are greetings. They are read whatever the sender's version, so
// that two sides of different versions can report it to each other.
inline constexpr std::uint8_t kGreetingType = 0x01;

Bytes EncodeFrame(const Frame& frame);

struct LinkCounters {
  std::uint64_t frames = 0;         // good ones
  std::uint64_t garbage_bytes = 0;  // discarded, those of the bad frames counted below included
  std::uint64_t bad_crc = 0;        // frames
  std::uint64_t other_version = 0;  // frames
  std::uint64_t bad_payload = 0;    // frames of an unknown type, or whose payload does not fit it
  std::uint64_t lost = 0;           // sequence numbers that never came, modulo 256
  std::uint64_t repeated = 0;       // frames with the number of the one before; they are handed out all the same
};

// Feed it all bytes that arrive, in pieces of any size. It keeps no more than one frame, and what it reads after a zero
// does not depend on what came before it.
class FrameDecoder {
 public:
  std::vector<Frame> Feed(BytesView bytes);
  const LinkCounters& counters() const { return counters_; }
  std::uint8_t other_version() const { return other_version_; }  // the last foreign one

  // For the layer above, that knows the types.
  void CountBadPayload(const Frame& frame);

 private:
  void Close(std::vector<Frame>& frames);
  void Follow(std::uint8_t sequence);

  Bytes chunk_;  // since the last zero
  bool too_long_ = false;
  bool any_ = false;
  std::uint8_t last_sequence_ = 0;
  std::uint8_t other_version_ = 0;
  LinkCounters counters_;
};

}  // namespace merlin
