#include "robot/protocol/operator.h"

namespace merlin::operator_link {
namespace {

constexpr std::uint8_t kType = 0x10;
enum Switch : std::uint8_t { kHeld = 1, kOverride = 2, kAutonomy = 4 };

}  // namespace

Bytes Encode(const Message& message, std::uint8_t sequence) {
  const int switches =
      (message.held ? kHeld : 0) | (message.override_stop ? kOverride : 0) | (message.autonomy ? kAutonomy : 0);
  return EncodeFrame(
      {.type = kType, .sequence = sequence, .payload = {message.command, static_cast<std::uint8_t>(switches)}});
}

std::optional<Message> Decoder::Feed(BytesView bytes) {
  std::optional<Message> newest;
  for (const Frame& frame : frames_.Feed(bytes)) {
    if (frame.type != kType || frame.payload.size() != 2) {
      frames_.CountBadPayload(frame);
      continue;
    }
    const std::uint8_t switches = frame.payload[1];
    newest = Message{.command = frame.payload[0],
                     .held = (switches & kHeld) != 0,
                     .override_stop = (switches & kOverride) != 0,
                     .autonomy = (switches & kAutonomy) != 0};
  }
  return newest;
}

}  // namespace merlin::operator_link
