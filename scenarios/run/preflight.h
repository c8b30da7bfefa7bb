// The check before a real car drives: is every device there, does it deliver at its rate, and can what it says be true?
// It needs a clock that runs by itself or is stepped by waiting, and finds faults of devices and cables, not of the map.
//
//   rate              within 30 % of the device's own (a machine that is busy elsewhere loses frames, half the rate is a
//                     fault); a device that does not know its rate must deliver at all
//   battery           0.9 to 1.3 of the car's nominal voltage: ten NiMH cells of 12 V have 10 V when empty, 15 V when full
//   roll, pitch       within 5 degrees of level, on average
//   range image       at least one valid pixel, and not one range all over
//   colour picture    not one colour all over
//   steering, current finite numbers
//
// All limits are guesses; none is met by chance.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "robot/hal/hal.h"
#include "robot/types/car.h"

namespace merlin {

// Listens to every device for two seconds; moves nothing. One sentence a fault, all faults; none: the car may drive.
// A device that its driver reports as broken by an exception is a fault, too.
std::vector<std::string> PreflightAtRest(const Robot& robot, const CarDescription& car);

// Moves the car, and brings it back: 5 cm forwards and back, 15 cm in which the commands suddenly stop, and an arc of
// 30 cm to each side. It needs half a metre of free floor ahead and at both sides. The wheels must turn as the commands
// say (by encoder and steering servo), the car must stand in time once no command comes any more, and the compass must
// turn as the wheels say. Ends at the first of the three that fails, or when stop is set (Ctrl-C), and halts the car in
// every case.
std::vector<std::string> PreflightMoving(const Robot& robot, const CarDescription& car, const std::atomic<bool>& stop);

}  // namespace merlin
