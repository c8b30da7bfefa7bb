#include "robot/protocol/cobs.h"

#include <algorithm>

namespace merlin {
namespace {

constexpr std::uint8_t kFullBlock = 0xFF;  // 254 bytes and no zero behind them

}  // namespace

Bytes CobsEncode(BytesView bytes) {
  Bytes stuffed{1};
  std::size_t code = 0;  // index of the block's length, which is counted up as the block grows
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != 0) {
      stuffed.push_back(bytes[i]);
      ++stuffed[code];
    }
    const bool full = stuffed[code] == kFullBlock && i + 1 < bytes.size();
    if (bytes[i] != 0 && !full) continue;
    code = stuffed.size();
    stuffed.push_back(1);
  }
  return stuffed;
}

std::optional<Bytes> CobsDecode(BytesView stuffed) {
  Bytes bytes;
  if (std::find(stuffed.begin(), stuffed.end(), 0) != stuffed.end()) return std::nullopt;
  while (!stuffed.empty()) {
    const std::size_t block = stuffed[0];
    if (block > stuffed.size()) return std::nullopt;
    bytes.insert(bytes.end(), stuffed.begin() + 1, stuffed.begin() + static_cast<std::ptrdiff_t>(block));
    stuffed = stuffed.subspan(block);
    if (block != kFullBlock && !stuffed.empty()) bytes.push_back(0);
  }
  return bytes;
}

}  // namespace merlin
