// The messages in valid frames, which random bytes practically never form: the first byte is the type, the others are
// the payload. Only what fits its type and direction is accepted, and what was decoded can be encoded again.
#include <algorithm>

#include "robot/protocol/microcontroller.h"
#include "tests/fuzz/target.h"

namespace merlin {
namespace {

using namespace microcontroller;

constexpr std::uint8_t kHello = 0x01, kCommand = 0x02, kPanCommand = 0x03, kHelloReply = 0x81, kState = 0x82;

bool Fits(ToMicro, std::uint8_t type, BytesView payload) {
  return (type == kHello && payload.empty()) || (type == kCommand && payload.size() == 12) ||
         (type == kPanCommand && payload.size() == 2);
}

bool Fits(ToHost, std::uint8_t type, BytesView payload) {
  const auto printable = [](std::uint8_t c) { return c >= ' ' && c <= '~'; };
  return (type == kState && payload.size() == 18) ||
         (type == kHelloReply && !payload.empty() && std::ranges::all_of(payload.subspan(1), printable));
}

template <class Message>
std::vector<Received<Message>> Read(const Bytes& wire) {
  return Decoder<Message>().Feed(wire);
}

template <class Message>
void Check(std::uint8_t type, BytesView payload) {
  const auto received = Read<Message>(EncodeFrame({type, 7, Bytes(payload.begin(), payload.end())}));
  fuzz::Expect((received.size() == 1) == Fits(Message(), type, payload), "what fits is a message, and nothing else");
  if (received.empty()) return;
  // Encoded twice, because a command of no duration is encoded as a stop, whatever its speed was.
  const auto said = Read<Message>(Encode(received[0].message, 8));
  fuzz::Expect(said.size() == 1, "a message is said again");
  const auto again = Read<Message>(Encode(said[0].message, 9));
  fuzz::Expect(again.size() == 1 && again[0].message == said[0].message, "and again, the same");
}

Bytes Payload(std::uint8_t type, std::size_t size) {
  Bytes bytes(1 + size, 0x41);
  bytes[0] = type;
  return bytes;
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  return {Payload(kHello, 0), Payload(kCommand, 12), Payload(kPanCommand, 2), Payload(kHelloReply, 7),
          Payload(kState, 18)};
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const merlin::BytesView payload =
      merlin::BytesView(data, size).subspan(1, std::min(size - 1, merlin::kPayloadMax_bytes));
  merlin::Check<merlin::microcontroller::ToMicro>(data[0], payload);
  merlin::Check<merlin::microcontroller::ToHost>(data[0], payload);
  return 0;
}
