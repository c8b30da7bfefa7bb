#include "scenarios/run/emulated_plug.h"

#include "scenarios/run/emulation.h"
#include "scenarios/run/ground_truth.h"
#include "scenarios/run/hardware_plug.h"
#include "scenarios/run/twin_versions.h"

namespace merlin {
namespace {

class EmulatedPlug : public Plug {
 public:
  explicit EmulatedPlug(const RunOptions& options)
      : emulation_(options, clock_), hardware_(emulation_.Devices(), emulation_.cameras(), clock_) {
    RequireReady(hardware_);
    clock_.EndAt(clock_.Now() + FromSeconds(options.scenario.duration_s));
  }

  PlugTraits traits() const override { return {.knows_truth = true}; }
  Robot robot() override { return hardware_.robot(); }
  void Keep(Time stamp) override {
    emulation_.WithTruth([&](merlin::Truth& truth, const sim::World&) { truth.Keep(stamp); });
  }
  std::string ReasonToEnd() override {
    return emulation_.WithTruth([](const merlin::Truth& truth, const sim::World&) { return truth.car_lost(); });
  }
  std::vector<std::string> Complaints() const override { return hardware_.Complaints(); }
  std::optional<GroundTruth> Truth() override {
    emulation_.robot().Stop();
    return emulation_.WithTruth(GroundTruthOf);
  }
  std::vector<std::string> notes() const override { return emulation_.Notes(); }
  std::string renderer() const override { return emulation_.renderer(); }
  std::vector<std::pair<std::string, std::string>> versions() const override { return TwinVersions(); }

 private:
  RealClock clock_{{}, Time::max()};
  Emulation emulation_;
  HardwareRobot hardware_;
};

}  // namespace

std::unique_ptr<Plug> MakeEmulatedPlug(const RunOptions& options) { return std::make_unique<EmulatedPlug>(options); }

}  // namespace merlin
