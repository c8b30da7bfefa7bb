#include "robot/protocol/joystick.h"

#include <algorithm>

namespace merlin::joystick {
namespace {

constexpr std::uint8_t kButton = 0x01, kAxis = 0x02, kInit = 0x80;
constexpr double kFullScale = 32767.0;

std::uint32_t LittleEndian(BytesView bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

}  // namespace

void Decoder::Feed(BytesView read) {
  while (read.size() >= kEvent_bytes) {
    if (!Take(read.first(kEvent_bytes))) garbage_bytes_ += kEvent_bytes;
    read = read.subspan(kEvent_bytes);
  }
  garbage_bytes_ += read.size();
}

bool Decoder::Take(BytesView event) {
  const auto value = static_cast<std::int16_t>(LittleEndian(event.subspan(4, 2)));
  const std::uint8_t type = event[6] & static_cast<std::uint8_t>(~kInit), number = event[7];
  if (number >= kMax) return false;
  if (type == kButton)
    state_.buttons[number] = value != 0;
  else if (type == kAxis)
    state_.axes[number] = std::max(value / kFullScale, -1.0);
  else
    return false;
  state_.time_ms = LittleEndian(event.first(4));
  return true;
}

}  // namespace merlin::joystick
