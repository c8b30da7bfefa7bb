#include "scenarios/run/twin_plug.h"

#include "scenarios/run/ground_truth.h"
#include "scenarios/run/twin_options.h"
#include "scenarios/run/twin_versions.h"

namespace merlin {
namespace {

class TwinPlug : public Plug {
 public:
  explicit TwinPlug(const RunOptions& options) {
    std::string without_color;
    MakeWithColor(TwinOptionsOf(options.scenario, options), options.scenario, without_color,
                  [this](const TwinOptions& with) { twin_ = std::make_unique<Twin>(with); });
    RequirePlan(options.scenario, twin_->world());
    notes_ = NotesOf(without_color, twin_->world());
    truth_.emplace(options.scenario, twin_->world());
    twin_->OnStep([this](sim::World& world) { truth_->Watch(world); });
  }

  PlugTraits traits() const override { return {.knows_truth = true, .repeats = true, .world_waits = true}; }
  Robot robot() override { return twin_->robot(); }
  void Keep(Time stamp) override { truth_->Keep(stamp); }
  std::string ReasonToEnd() override { return truth_->car_lost(); }
  std::optional<GroundTruth> Truth() override { return GroundTruthOf(*truth_, twin_->world()); }
  std::vector<std::string> notes() const override { return notes_; }
  std::string renderer() const override { return twin_->gl_name(); }
  std::vector<std::pair<std::string, std::string>> versions() const override { return TwinVersions(); }

 private:
  std::unique_ptr<Twin> twin_;
  std::optional<merlin::Truth> truth_;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<Plug> MakeTwinPlug(const RunOptions& options) { return std::make_unique<TwinPlug>(options); }

}  // namespace merlin
