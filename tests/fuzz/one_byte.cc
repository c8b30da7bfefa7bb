// The one-byte command: each byte decodes to a command within the limits, which encodes to the same byte.
#include "robot/protocol/one_byte.h"

#include <cmath>

#include "tests/fuzz/target.h"

namespace merlin {
namespace {

constexpr OneByteLimits kLimits;
constexpr Duration kHolds = std::chrono::milliseconds(200);

}  // namespace

std::vector<Bytes> fuzz::Seeds() { return {{0x77, 0x99, 0x80, 0x08, 0x00}}; }

}  // namespace merlin

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace merlin;
  for (const std::uint8_t byte : BytesView(data, size)) {
    const DriveCommand command = DecodeOneByte(byte, kLimits, kHolds);
    fuzz::Expect(std::abs(command.speed_m_s) <= kLimits.speed_m_s, "a speed is within the limit");
    fuzz::Expect(std::abs(command.steering_rad) <= kLimits.steering_rad, "a steering angle is within the limit");
    const bool no_number = byte >> 4 == 8 || (byte & 15) == 8;
    fuzz::Expect(EncodeOneByte(command, kLimits) == (no_number ? 0 : byte), "a command is said again");
  }
  return 0;
}
