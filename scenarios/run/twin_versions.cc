#include "scenarios/run/twin_versions.h"

#include <mujoco/mujoco.h>

#include "sim/rays/embree.h"

namespace merlin {

std::vector<std::pair<std::string, std::string>> TwinVersions() {
  return {{"mujoco", mj_versionString()}, {"embree", RTC_VERSION_STRING}};
}

}  // namespace merlin
