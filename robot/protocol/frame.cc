#include "robot/protocol/frame.h"

#include <cassert>
#include <optional>
#include <utility>

#include "robot/protocol/cobs.h"
#include "robot/protocol/crc16.h"

namespace merlin {
namespace {

constexpr std::size_t kHead_bytes = 3, kCrc_bytes = 2;
constexpr std::size_t kStuffedMax_bytes = kFrameMax_bytes - 2;
constexpr std::uint8_t kFromMicro = 0x80;

bool IsGreeting(std::uint8_t type) { return (type & ~kFromMicro) == kGreetingType; }

}  // namespace

Bytes EncodeFrame(const Frame& frame) {
  assert(frame.payload.size() <= kPayloadMax_bytes);
  Bytes plain;
  plain.reserve(kFrameMax_bytes);
  for (const std::uint8_t byte : {kProtocolVersion, frame.type, frame.sequence}) plain.push_back(byte);
  plain.insert(plain.end(), frame.payload.begin(), frame.payload.end());
  Put(plain, Crc16(plain));
  Bytes wire = CobsEncode(plain);
  wire.insert(wire.begin(), 0);
  wire.push_back(0);
  return wire;
}

std::vector<Frame> FrameDecoder::Feed(BytesView bytes) {
  std::vector<Frame> frames;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) {
      Close(frames);
    } else if (chunk_.size() < kStuffedMax_bytes) {
      chunk_.push_back(byte);
    } else {
      too_long_ = true;
      ++counters_.garbage_bytes;
    }
  }
  return frames;
}

void FrameDecoder::Close(std::vector<Frame>& frames) {
  const Bytes chunk = std::move(chunk_);
  chunk_.clear();
  const bool too_long = std::exchange(too_long_, false);
  if (chunk.empty()) return;
  counters_.garbage_bytes += chunk.size();  // taken back below if a good frame is found
  const std::optional<Bytes> plain = too_long ? std::nullopt : CobsDecode(chunk);
  if (!plain || plain->size() < kHead_bytes + kCrc_bytes) return;
  const BytesView covered = BytesView(*plain).first(plain->size() - kCrc_bytes);
  if (ByteReader(BytesView(*plain).last(kCrc_bytes)).Take<std::uint16_t>() != Crc16(covered)) {
    ++counters_.bad_crc;
    return;
  }
  const std::uint8_t version = covered[0], type = covered[1], sequence = covered[2];
  if (version != kProtocolVersion) {
    ++counters_.other_version;
    other_version_ = version;
    if (!IsGreeting(type)) return;
  }
  counters_.garbage_bytes -= chunk.size();
  ++counters_.frames;
  Follow(sequence);
  frames.push_back({type, sequence, Bytes(covered.begin() + kHead_bytes, covered.end())});
}

void FrameDecoder::Follow(std::uint8_t sequence) {
  const auto step = static_cast<std::uint8_t>(sequence - last_sequence_);
  if (any_ && step == 0) ++counters_.repeated;
  if (any_ && step > 1) counters_.lost += step - 1u;
  any_ = true;
  last_sequence_ = sequence;
}

void FrameDecoder::CountBadPayload(const Frame& frame) {
  --counters_.frames;
  ++counters_.bad_payload;
  counters_.garbage_bytes += frame.payload.size() + kHead_bytes + kCrc_bytes + 1;  // 1: of COBS
}

}  // namespace merlin
