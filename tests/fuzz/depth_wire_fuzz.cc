// Fuzz target of the wire between the twin and its vendor library: what the decoder accepts it understands whole (it
// encodes to the very bytes), and it never reads or asks for more than there can be.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "robot/twin/devices/depth_wire.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Kind = merlin::WireReading::Kind;
  std::span<const std::uint8_t> rest(data, size);
  while (true) {
    const merlin::WireReading reading = merlin::Decode(rest);
    if (reading.message.has_value() != (reading.kind == Kind::kMessage)) std::abort();
    if (reading.kind != Kind::kMessage) return 0;
    if (reading.bytes < 12 || reading.bytes > rest.size()) std::abort();
    if (!std::ranges::equal(merlin::Encode(*reading.message), rest.first(reading.bytes))) std::abort();
    rest = rest.subspan(reading.bytes);
  }
}
