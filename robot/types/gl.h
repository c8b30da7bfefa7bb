// How MuJoCo draws what the simulated colour camera sees.
#pragma once

namespace merlin {

enum class Gl { kAuto, kEgl, kOsmesa, kOff };  // kAuto: EGL if it works here, else OSMesa; kOff: no colour

}  // namespace merlin
