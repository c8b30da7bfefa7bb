#include "scenarios/run/hardware_plug.h"

#include "robot/base/error.h"
#include "scenarios/config/hardware_check.h"
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
  if (IsOnStand(scenario.task))
    throw InputError("task.behavior", "turn_on_stand: only the twin has a stand", "merlin run with --robot twin");
}

std::unique_ptr<Plug> MakeHardwarePlug(const RunOptions& options) {
  RequireNoTurntable(options.scenario);
  const HardwareConfig config = ReadHardwareFile(options.hardware_file);
  RequireFits(config, options.scenario, options.hardware_file);
  return std::make_unique<HardwarePlug>(config, options.scenario);
}

}  // namespace merlin
