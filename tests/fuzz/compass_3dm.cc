// The 3DM's poller: whatever bytes arrive, the next poll that gets a correct answer gives its reading.
#include "robot/protocol/compass_3dm.h"

#include <algorithm>

#include "tests/fuzz/target.h"

namespace merlin {
namespace {

using namespace compass_3dm;

constexpr Counts kCounts{0x4444, 0x8000, 0x00FF};

void Check(BytesView input, bool with_checksum) {
  if (const auto counts = DecodeReply(input, with_checksum))
    fuzz::Expect(std::ranges::equal(EncodeReply(*counts, with_checksum), input), "a reply is said again byte by byte");
  Poller poller({.with_checksum = with_checksum});
  Time now{0};
  // The first byte of each piece says how long to wait, and how long the piece is.
  for (BytesView rest = input; !rest.empty();) {
    const std::size_t size = std::min<std::size_t>(rest[0] % 16, rest.size() - 1);
    now += std::chrono::milliseconds(rest[0] / 4);
    poller.Receive(now, rest.subspan(1, size));
    const Bytes sent = poller.Send(now);
    fuzz::Expect(sent.size() <= 1, "a byte at a time");
    fuzz::Expect(poller.next() >= now || sent.empty(), "it asks to be called in the future");
    poller.Take();
    rest = rest.subspan(1 + size);
  }
  while (poller.Send(poller.next()) != Bytes{kSendAngles}) continue;
  fuzz::Expect(poller.garbage_bytes() <= input.size(), "no more bytes are thrown away than came");
  poller.Take();
  poller.Receive(poller.next(), EncodeReply(kCounts, with_checksum));
  poller.Send(poller.next());
  const auto reading = poller.Take();
  fuzz::Expect(reading && reading->counts == kCounts, "a good reply is read whatever came before its poll");
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  return {EncodeReply(kCounts, false),
          EncodeReply(kCounts, true),
          {0x00, 0x8C, 0x00, 0x8C, 0x17, 0x44, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x8C, 0x00}};  // a whole poll
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  merlin::Check({data, size}, false);
  merlin::Check({data, size}, true);
  return 0;
}
