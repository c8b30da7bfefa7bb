// Helpers for code that adds elements to a room's MJCF: MuJoCo's own defaults, and names that are checked.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "robot/base/error.h"

namespace merlin::sim {

using SpecPtr = std::unique_ptr<mjSpec, void (*)(mjSpec*)>;
using ModelPtr = std::unique_ptr<mjModel, void (*)(mjModel*)>;

// A room's <default> also reaches elements that are added with no default class given. This is the class of a spec of
// its own, that is MuJoCo's built-in values; elements copy it when they are added.
class BuiltinDefaults {
 public:
  const mjsDefault* get() const { return mjs_getSpecDefault(spec_.get()); }

 private:
  SpecPtr spec_{mj_makeSpec(), mj_deleteSpec};
};

// Throws InputError if the spec has an element of that kind and name.
inline void SetName(mjsElement* element, const std::string& name) {
  if (mjs_setName(element, name.c_str()) != 0)
    throw InputError("the room with the car in it", "a name is used twice", "names of the room's own",
                     "'" + name + "'");
}

}  // namespace merlin::sim
