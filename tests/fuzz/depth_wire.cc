// The protocol between the twin and its vendor library: a message that the decoder accepts encodes to the same bytes,
// and the decoder never reads or asks for more than there can be.
#include "robot/emulated/depth_wire.h"

#include <algorithm>

#include "tests/fuzz/target.h"

namespace merlin {
namespace {

Bytes Joined(Bytes first, const Bytes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

std::vector<Bytes> fuzz::Seeds() {
  const Bytes frame = Encode(WireFrame{.columns = 2,
                                       .rows = 1,
                                       .stamp_ns = 0x0102030405060708,
                                       .settings = {1000, 20000000, 0},
                                       .range_m = {1.0f, 2.0f},
                                       .amplitude = {0.5f, 0.0f},
                                       .intensity = {7, 255},
                                       .flags = {0, 17}});
  const WireHello hello{.camera = {.width = 2, .height = 1, .fx_px = 1.0, .fy_px = 1.0, .cx_px = 0.5, .cy_px = 0.0},
                        .integration_min_us = 100,
                        .integration_max_us = 5000,
                        .frequencies_hz = {20000000, 30000000},
                        .settings = {1000, 20000000, 0}};
  return {frame,
          Encode(hello),
          Encode(WireUpdate{}),
          Encode(WireSet{{1, 2, 3}}),
          Encode(WireDone{}),
          Encode(WireRefused{"no"}),
          Joined(Encode(WireDone{}), frame)};
}

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace merlin;
  using Kind = WireReading::Kind;
  for (BytesView rest(data, size);;) {
    const WireReading reading = Decode(rest);
    fuzz::Expect(reading.message.has_value() == (reading.kind == Kind::kMessage), "a message is there or not");
    if (reading.kind != Kind::kMessage) return 0;
    fuzz::Expect(reading.bytes >= 12 && reading.bytes <= rest.size(), "a message is among the bytes that came");
    fuzz::Expect(std::ranges::equal(Encode(*reading.message), rest.first(reading.bytes)), "it is said again");
    rest = rest.subspan(reading.bytes);
  }
}
