// Helpers for code that adds elements to a room's MJCF: MuJoCo's own defaults, and names that are checked.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "robot/base/error.h"

namespace merlin::sim {

using SpecPtr = std::unique_ptr<mjSpec, void (*)(mjSpec*)>;
using ModelPtr = std::unique_ptr<mjModel, void (*)(mjModel*)>;

// MuJoCo's built-in default class, taken from an empty spec. Elements added to a room without a default class would get
// the room's <default>; elements added with this one copy the built-in values.
class BuiltinDefaults {
 public:
  const mjsDefault* get() const { return mjs_getSpecDefault(spec_.get()); }

 private:
  SpecPtr spec_{mj_makeSpec(), mj_deleteSpec};
};

// Throws InputError if the spec already has an element of that kind and name.
inline void SetName(mjsElement* element, const std::string& name) {
  if (mjs_setName(element, name.c_str()) != 0)
    throw InputError("the room with the car in it", "a name is used twice", "names that the car does not use",
                     "'" + name + "'");
}

}  // namespace merlin::sim
