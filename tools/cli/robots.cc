#include "tools/cli/robots.h"

#include "robot/base/error.h"
#include "scenarios/run/hardware_plug.h"
#include "tools/cli/commands.h"
#if MERLIN_TWIN
#include "scenarios/run/plugs.h"
#endif

namespace merlin::cli {

Gl GlOf(const std::string& name) {
  return name == "egl" ? Gl::kEgl : name == "osmesa" ? Gl::kOsmesa : name == "off" ? Gl::kOff : Gl::kAuto;
}

PlugMaker PlugOf(const std::string& robot, RunOptions& options) {
  const std::string hardware = "hardware:";
  if (robot.starts_with(hardware) && robot.size() > hardware.size()) {
    options.robot = RobotKind::kHardware;
    options.hardware_file = robot.substr(hardware.size());
    return MakeHardwarePlug;
  }
  if (robot != "twin" && robot != "emulated")
    throw InputError("--robot", "unknown robot", "twin, emulated or hardware:FILE", "'" + robot + "'");
#if MERLIN_TWIN
  options.robot = robot == "twin" ? RobotKind::kTwin : RobotKind::kEmulated;
  return MakePlug;
#else
  throw InputError("--robot", "this program was built without the twin", "hardware:FILE", "'" + robot + "'");
#endif
}

int ExitCodeOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
    case Verdict::kNotJudged:
      return kPass;
    case Verdict::kInterrupted:
      return kInterrupted;
    default:
      return kFail;
  }
}

}  // namespace merlin::cli
