#include "scenarios/run/emulated_plug.h"

#include <fmt/format.h>

#include "scenarios/config/hardware_file.h"
#include "scenarios/run/emulated_devices.h"
#include "scenarios/run/ground_truth.h"
#include "scenarios/run/hardware_plug.h"
#include "scenarios/run/twin_options.h"
#include "scenarios/run/twin_versions.h"

namespace merlin {
namespace {

class EmulatedPlug : public Plug {
 public:
  explicit EmulatedPlug(const RunOptions& options) {
    std::string without_color;
    HardwareCameras cameras = CamerasOf(options.scenario);
    MakeWithColor(TwinOptionsOf(options.scenario, options), options.scenario, without_color,
                  [&](const TwinOptions& with) {
                    emulated_ = std::make_unique<EmulatedRobot>(with, sockets_.path(), clock_);
                    if (!with.color) cameras.color.reset();
                  });
    emulated_->With([&](Twin& twin) {
      RequirePlan(options.scenario, twin.world());
      truth_.emplace(options.scenario, twin.world());
      twin.OnStep([this](sim::World& world) { truth_->Watch(world); });
      renderer_ = twin.gl_name();
      notes_ = NotesOf(without_color, twin.world());
    });
    emulated_->Start();
    hardware_.emplace(DevicesOf(*emulated_), cameras, clock_);
    RequireReady(*hardware_);
    clock_.EndAt(clock_.Now() + FromSeconds(options.scenario.duration_s));
  }

  PlugTraits traits() const override { return {.knows_truth = true}; }
  Robot robot() override { return hardware_->robot(); }
  void Keep(Time stamp) override {
    emulated_->With([&](Twin&) { truth_->Keep(stamp); });
  }
  std::string ReasonToEnd() override {
    if (const std::exception_ptr failure = emulated_->failure()) std::rethrow_exception(failure);
    return emulated_->With([&](Twin&) { return truth_->car_lost(); });
  }
  std::vector<std::string> Complaints() const override { return hardware_->Complaints(); }
  std::optional<GroundTruth> Truth() override {
    emulated_->Stop();
    return emulated_->With([&](Twin& twin) { return GroundTruthOf(*truth_, twin.world()); });
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes = notes_;
    if (emulated_->lag() > std::chrono::milliseconds(100))
      notes.push_back(fmt::format("the world fell {:.0f} ms behind the clock: this machine was too slow at times",
                                  1e3 * Seconds(emulated_->lag())));
    return notes;
  }
  std::string renderer() const override { return renderer_; }
  std::vector<std::pair<std::string, std::string>> versions() const override { return TwinVersions(); }

 private:
  SocketFolder sockets_;
  RealClock clock_{{}, Time::max()};
  std::optional<merlin::Truth> truth_;  // before the robot, whose thread watches it until its end
  std::unique_ptr<EmulatedRobot> emulated_;
  std::optional<HardwareRobot> hardware_;
  std::string renderer_;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<Plug> MakeEmulatedPlug(const RunOptions& options) {
  RequireNoTurntable(options.scenario);
  return std::make_unique<EmulatedPlug>(options);
}

}  // namespace merlin
