#include "scenarios/run/hardware_plug.h"

#include "robot/base/error.h"
#include "scenarios/config/believed_car.h"
#include "scenarios/config/hardware_check.h"
#include "scenarios/config/hardware_file.h"
#include "scenarios/run/preflight.h"

namespace merlin {
namespace {

constexpr Duration kReady = std::chrono::seconds(10);

// Throws MachineError, a line for each fault, if there are any.
void ThrowAll(const std::vector<std::string>& faults) {
  std::string lines;
  for (const std::string& fault : faults) lines += (lines.empty() ? "" : "\n") + fault;
  if (!lines.empty()) throw MachineError(lines);
}

class HardwarePlug : public Plug {
 public:
  HardwarePlug(const HardwareConfig& config, const Scenario& scenario)
      : clock_(config.clock, Time::max()), hardware_(config, CamerasOf(scenario), clock_) {
    RequireReady(hardware_);
    ThrowAll(PreflightAtRest(hardware_.robot(), BelievedCar(scenario.car)));
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

void RequireReady(HardwareRobot& robot) { ThrowAll(robot.WaitUntilReady(kReady)); }

void RequireNoTurntable(const Scenario& scenario) {
  if (IsOnTurntable(scenario.task))
    throw InputError("task.behavior", scenario.task.behavior + ": only the twin has a turntable",
                     "merlin run with --robot twin");
}

std::unique_ptr<Plug> MakeHardwarePlug(const RunOptions& options) {
  RequireNoTurntable(options.scenario);
  const HardwareConfig config = ReadHardwareFile(options.hardware_file);
  RequireFits(config, options.scenario, options.hardware_file);
  return std::make_unique<HardwarePlug>(config, options.scenario);
}

}  // namespace merlin
