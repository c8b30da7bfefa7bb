// Joystick events: whatever a read gives, axes stay within their range, and the next read is decoded correctly.
#include "robot/protocol/joystick.h"

#include <algorithm>

#include "tests/fuzz/target.h"

namespace merlin {
namespace {

const Bytes kAxis0Full{1, 0, 0, 0, 0xFF, 0x7F, 0x02, 0x00};

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  return {kAxis0Full, {2, 0, 0, 0, 0x01, 0x00, 0x81, 0x1F}, {3, 0, 0, 0, 0x00, 0x80, 0x82, 0x1F}};
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using merlin::fuzz::Expect;
  merlin::joystick::Decoder decoder;
  decoder.Feed({data, size});
  Expect(decoder.garbage_bytes() <= size, "no more bytes are thrown away than came");
  Expect(decoder.garbage_bytes() % merlin::joystick::kEvent_bytes == size % merlin::joystick::kEvent_bytes,
         "events and the incomplete rest are thrown away whole");
  for (const double axis : decoder.state().axes) Expect(axis >= -1.0 && axis <= 1.0, "an axis is within -1 and 1");
  decoder.Feed(merlin::kAxis0Full);
  Expect(decoder.state().axes[0] == 1.0, "the next read is understood");
  return 0;
}
