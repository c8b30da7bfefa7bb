#include "scenarios/run/hardware_plug.h"

#include "robot/base/error.h"
#include "scenarios/config/hardware_file.h"

namespace merlin {
namespace {

constexpr Duration kReady = std::chrono::seconds(10);

class HardwarePlug : public Plug {
 public:
  HardwarePlug(const HardwareConfig& config, const Scenario& scenario)
      : clock_(config.clock, Time::max()), hardware_(config, CamerasOf(scenario), clock_) {
    RequireReady(hardware_);
    clock_.EndAt(clock_.Now() + FromSeconds(scenario.duration_s));
  }

  PlugTraits traits() const override { return {}; }
  Robot robot() override { return hardware_.robot(); }
  std::vector<std::string> Complaints() const override { return hardware_.Complaints(); }

 private:
  RealClock clock_;
  HardwareRobot hardware_;
};

}  // namespace

void RequireReady(HardwareRobot& robot) {
  std::string faults;
  for (const std::string& fault : robot.WaitUntilReady(kReady)) faults += (faults.empty() ? "" : "\n") + fault;
  if (!faults.empty()) throw MachineError(faults);
}

void RequireNoTurntable(const Scenario& scenario) {
  if (IsOnTurntable(scenario.task))
    throw InputError("task.behavior", scenario.task.behavior + ": only the twin has a turntable",
                     "merlin run with --robot twin");
}

std::unique_ptr<Plug> MakeHardwarePlug(const RunOptions& options) {
  RequireNoTurntable(options.scenario);
  return std::make_unique<HardwarePlug>(ReadHardwareFile(options.hardware_file), options.scenario);
}

}  // namespace merlin
