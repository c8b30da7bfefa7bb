// A behaviour looks at a situation and says what the car should do next. It never talks to a device and never looks out
// for obstacles: the pilot does that.
//
// To write one: a small class with its own config and one method, `Intent Decide(const Situation&)`, in a pair of files
// in this folder, and a row in the table (table.cc). Its state is copied with it.
#pragma once

#include <functional>

#include "autonomy/intent.h"
#include "autonomy/situation.h"

namespace merlin {

// Asked once per depth frame, as soon as the pose is known. It is asked when the car is lost, too: the pilot then does not
// let it drive.
using Behavior = std::function<Intent(const Situation&)>;

}  // namespace merlin
