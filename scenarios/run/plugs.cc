#include "scenarios/run/plugs.h"

#include "scenarios/run/emulated_plug.h"
#include "scenarios/run/hardware_plug.h"
#include "scenarios/run/twin_plug.h"

namespace merlin {

std::unique_ptr<Plug> MakePlug(const RunOptions& options) {
  switch (options.robot) {
    case RobotKind::kEmulated:
      return MakeEmulatedPlug(options);
    case RobotKind::kHardware:
      return MakeHardwarePlug(options);
    default:
      return MakeTwinPlug(options);
  }
}

RunReport RunScenario(const RunOptions& options, const std::atomic<bool>& stop) {
  return RunScenario(options, MakePlug, stop);
}

}  // namespace merlin
