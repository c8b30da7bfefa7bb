// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, nothing reflected, nothing inverted; "123456789" gives 0x29B1.
// Finds every error of one, two or an odd number of bits and every burst up to 16 bits in frames as short as ours.
#pragma once

#include <cstdint>

#include "robot/protocol/bytes.h"

namespace merlin {

std::uint16_t Crc16(BytesView bytes);

}  // namespace merlin
