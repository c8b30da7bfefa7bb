// Consistent overhead byte stuffing (Cheshire and Baker, IEEE/ACM Trans. Networking 7(2), 1999): bytes without a zero
// among them, so that a zero on the wire can only be the end of a frame. One byte more for up to 254.
#pragma once

#include <optional>

#include "robot/protocol/bytes.h"

namespace merlin {

Bytes CobsEncode(BytesView bytes);

// Empty if no encoder gives these bytes: they hold a zero, or a block is longer than the rest of them.
std::optional<Bytes> CobsDecode(BytesView stuffed);

}  // namespace merlin
