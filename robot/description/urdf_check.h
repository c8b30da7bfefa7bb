// Finds the faults of a URDF that urdfdom accepts or skips without an error, by reading the XML itself.
#pragma once

#include <set>
#include <string>

#include "robot/base/fault_list.h"
#include "robot/description/urdf_source.h"

namespace merlin {

struct UrdfFaults {
  FaultList list;
  // Names of the links and joints with a fault: further errors of urdfdom about them are not reported.
  std::set<std::string> parts;
};

// Adds a fault, with its line and the link or joint, for
// - each shape that would vanish: one that URDF does not know (capsule, ellipsoid, ...), an empty <geometry> or none, a
//   second shape in one, a shape outside a link;
// - attributes that are missing or no numbers, <mass> or <inertia> that is missing, a <material> without a name:
//   urdfdom drops the rest of the link with them;
// - joints of a type that a car cannot have, without limits, or between links that are not there;
// - names that are missing or given twice, links in a cycle, on two joints or on none;
// - left-overs of xacro: <xacro:...>, ${...}, $(...) other than $(find ...) in a mesh's file name.
// Elements that URDF does not define are ignored with all that is in them. If the whole file is xacro, that is the only
// fault reported. (In urdfdom a fault in a shape ends the reading of its link, and the return value is not checked.)
void CheckUrdf(const UrdfSource& source, UrdfFaults& faults);

}  // namespace merlin
