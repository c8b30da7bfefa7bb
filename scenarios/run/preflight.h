// The check before a real car drives: is every device present, does it deliver at its rate, and are its values
// plausible? It finds faults of devices and cables, not of the map. It needs a clock that runs by itself or advances
// when waited for.
//
//   rate              within 30 % of the device's own rate (a busy machine loses some frames; half the rate is a
//                     fault); a device without a known rate must deliver at least one measurement
//   battery           0.9 to 1.3 of the car's nominal voltage: ten NiMH cells of 12 V have 10 V when empty and 15 V
//                     when full
//   roll, pitch       within 5 degrees of level, on average
//   range image       at least one valid pixel, and not the same range in all of them
//   colour picture    not the same colour in all pixels
//   steering, current finite numbers
//
// All limits are guesses, wide enough that a healthy device does not violate them by chance.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "robot/hal/hal.h"
#include "robot/types/car.h"

namespace merlin {

// Listens to every device for two seconds without moving the car. Returns one sentence per fault; if there are none the
// car may drive. An exception of a driver is a fault as well.
std::vector<std::string> PreflightAtRest(const Robot& robot, const CarDescription& car);

// Moves the car and brings it back: 5 cm forwards and back, 15 cm during which the commands suddenly stop, and an arc
// of 30 cm to each side. It needs half a metre of free floor ahead and on both sides. Three checks: the wheels follow
// the commands (according to encoder and steering servo), the car stops in time after the last command, and the compass
// turns as the wheels do. Ends at the first check that fails, or when stop is set (Ctrl-C). Halts the car in every
// case.
std::vector<std::string> PreflightMoving(const Robot& robot, const CarDescription& car, const std::atomic<bool>& stop);

}  // namespace merlin
