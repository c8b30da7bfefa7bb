// The operator's message: whatever arrives, a good frame after it is decoded, and what was decoded can be encoded
// again. The input is used as bytes of the wire, and as the payload of a valid frame, which random bytes practically
// never form.
#include "robot/protocol/operator.h"

#include <algorithm>

#include "tests/fuzz/target.h"

namespace merlin {
namespace {

using namespace operator_link;

constexpr std::uint8_t kType = 0x10;
constexpr Message kMessage{.command = 0x71, .held = true, .autonomy = true};
const Bytes kWire = Encode(kMessage, 7);

void CheckBytes(BytesView input) {
  Decoder decoder;
  if (const auto message = decoder.Feed(input))
    fuzz::Expect(Decoder().Feed(Encode(*message, 1)) == message, "a message that was read is read again");
  fuzz::Expect(decoder.counters().garbage_bytes <= input.size(), "no more bytes are thrown away than came");
  fuzz::Expect(decoder.Feed(kWire) == kMessage, "a good frame is read whatever came before it");
}

void CheckPayload(BytesView input) {
  const Bytes payload(input.begin(), input.begin() + std::min<std::ptrdiff_t>(std::ssize(input), kPayloadMax_bytes));
  Decoder decoder;
  const auto message = decoder.Feed(EncodeFrame({.type = kType, .payload = payload}));
  fuzz::Expect(message.has_value() == (payload.size() == 2), "a message is two bytes");
  if (!message) return;
  fuzz::Expect(message->command == payload[0], "the first is the command");
  fuzz::Expect(
      (message->held ? 1 : 0) + (message->override_stop ? 2 : 0) + (message->autonomy ? 4 : 0) == (payload[1] & 7),
      "the second has the switches");
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() { return {kWire, Encode({}, 8), {0x77, 0x07}}; }

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::CheckBytes({data, size});
  merlin::CheckPayload({data, size});
  return 0;
}
