#include "robot/protocol/crc16.h"

#include <array>

namespace merlin {
namespace {

constexpr std::uint16_t kPolynomial = 0x1021;

// What each value of the top byte adds once it is shifted out.
constexpr std::array<std::uint16_t, 256> Table() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000u) != 0 ? kPolynomial : 0u);
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}
constexpr std::array<std::uint16_t, 256> kTable = Table();

}  // namespace

std::uint16_t Crc16(BytesView bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) crc = ((crc << 8) ^ kTable[((crc >> 8) ^ byte) & 0xFF]) & 0xFFFF;
  return static_cast<std::uint16_t>(crc);
}

}  // namespace merlin
