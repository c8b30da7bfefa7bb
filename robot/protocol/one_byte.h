// A drive command in one byte. The thesis says of MERLIN's own protocol no more than that 8 bits of data command the
// movement; this is our reading of it, for a microcontroller that takes nothing else: the high half is the speed, the
// low half the steering, each a two's complement number of -7 to 7 sevenths of the car's limit. Forwards and left are
// positive. -8 is not a number of this code and reads as a stop, as does 0x00. The receiver
// decides how long it is valid: its watchdog brakes when no byte comes.
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
#pragma once

#include <cstdint>

#include "robot/types/measurements.h"

namespace merlin {

struct OneByteLimits {
  double speed_m_s = 2.0;       // what 7 means
  double steering_rad = 0.436;  // 25 deg
};

// The nearest step, clamped to the limits. 0x00 for numbers that are not finite and for commands that have expired.
std::uint8_t EncodeOneByte(const DriveCommand& command, const OneByteLimits& limits);

DriveCommand DecodeOneByte(std::uint8_t byte, const OneByteLimits& limits, Duration valid_for);

}  // namespace merlin
