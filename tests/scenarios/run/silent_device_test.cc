// How the loop and the run react to devices that fall silent during a drive, in the twin.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "robot/description/description.h"
#include "robot/twin/twin.h"
#include "scenarios/run/drive_loop.h"
#include "scenarios/run/twin_plug.h"
#include "tests/sim/world/car_world.h"
#include "tests/support/muted_robot.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

constexpr char kTwoWalls[] = R"(<geom name="floor" type="plane" size="0 0 1"/>
  <geom type="box" size="20 .1 1" pos="0 1.1 1"/> <geom type="box" size="20 .1 1" pos="0 -1.1 1"/>)";

constexpr Time kFault = std::chrono::seconds(4);

class SilentDevice : public ::testing::Test {
 protected:
  SilentDevice() : room_("room.xml", sim::Room(kTwoWalls)) {
    TwinOptions options;
    options.world.room = room_.path();
    options.world.car = sim::Merlin();
    options.depth.sheet =
        ReadDepthCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
    options.compass = TwinOptions::Compass{};
    options.end = std::chrono::seconds(10);
    options.threads = 1;
    twin_.emplace(options);
    muted_.emplace(twin_->robot());
    loop_.emplace(muted_->robot(), options.world.car, PerceptionConfig{}, SlamConfig{}, Task{}, PilotConfig{});
  }
  // Drives with the pilot. A fault begins after kFault and lasts for good, or until it ends.
  LoopEnd Drive(const std::function<void(bool broken)>& fault, Time until = Time::max()) {
    return loop_->Run(not_stopped_, [&](const LoopState& state) {
      fault(state.now >= kFault && state.now < until);
      if (state.now < kFault) fastest_m_s_ = std::max(fastest_m_s_, twin_->world().Speed_m_s());
      ended_ = state.now;
      return true;
    });
  }
  void ExpectStanding() {
    EXPECT_GT(fastest_m_s_, 0.4) << "it did not drive";
    EXPECT_LT(std::abs(twin_->world().Speed_m_s()), 0.01);
  }

  sim::TemporaryFile room_;
  std::optional<Twin> twin_;
  std::optional<MutedRobot> muted_;
  std::optional<DriveLoop> loop_;
  double fastest_m_s_ = 0.0;
  Time ended_{0};
  const std::atomic<bool> not_stopped_{false};
};

// The depth camera delivers at 20 Hz. The last frame arrives at kFault; 0.5 s later is the last tick that is tolerated.
TEST_F(SilentDevice, StopsTheCarHalfASecondAfterTheLastFrame) {
  EXPECT_EQ(Drive([this](bool broken) { muted_->depth.muted = broken; }), LoopEnd::kDeviceLost);
  EXPECT_EQ(loop_->state().stop, "the depth camera has been silent for 0.6 s");
  EXPECT_NEAR(Seconds(ended_ - kFault), 0.55, 0.001);
  ExpectStanding();
}

TEST_F(SilentDevice, StopsTheCarThatNoLongerTellsItsState) {
  EXPECT_EQ(Drive([this](bool broken) { muted_->drive.muted = broken; }), LoopEnd::kDeviceLost);
  EXPECT_EQ(loop_->state().stop, "the drive has been silent for 0.6 s");
  ExpectStanding();
}

// Frames still arrive, but their camera reports that they are unusable.
TEST_F(SilentDevice, StopsTheCarWhoseDepthCameraSaysThatItIsFaulty) {
  EXPECT_EQ(Drive([this](bool broken) {
              if (broken) muted_->depth.status = {.health = DeviceStatus::Health::kFaulty, .since = kFault};
            }),
            LoopEnd::kDeviceLost);
  EXPECT_EQ(loop_->state().stop, "the depth camera has been unreadable for 0.6 s");
  ExpectStanding();
}

TEST_F(SilentDevice, ForgivesACameraThatIsBackBeforeHalfASecondIsOver) {
  EXPECT_EQ(Drive([this](bool broken) { muted_->depth.muted = broken; }, kFault + std::chrono::milliseconds(450)),
            LoopEnd::kTimeUp);
  EXPECT_TRUE(loop_->state().stop.empty());
}

TEST_F(SilentDevice, DrivesOnWithoutItsCompassAndNotesIt) {
  EXPECT_EQ(Drive([this](bool broken) { muted_->compass.muted = broken; }), LoopEnd::kTimeUp);
  ASSERT_EQ(loop_->state().outages.size(), 1u);
  EXPECT_EQ(loop_->state().outages[0].Sentence(),
            "the compass was silent from 4.0 s on, and the run went on without it");
  const double gone_m = twin_->world().T_world_base().translation().x();
  EXPECT_GT(gone_m, 3.5) << "0.5 m/s for 10 s, less what the heading takes at the start";
  EXPECT_NEAR(loop_->state().path_m, gone_m, 0.1);
}

TEST_F(SilentDevice, NotesWhenTheCompassIsBack) {
  EXPECT_EQ(Drive([this](bool broken) { muted_->compass.muted = broken; }, kFault + std::chrono::seconds(2)),
            LoopEnd::kTimeUp);
  ASSERT_EQ(loop_->state().outages.size(), 1u);
  EXPECT_NEAR(Seconds(loop_->state().outages[0].until), 6.0, 0.11);
}

// One complete and consistent state per tick; a copy of it does not change.
TEST_F(SilentDevice, TellsEachTickAsACopy) {
  std::vector<LoopState> states;
  loop_->Run(not_stopped_, [&](const LoopState& state) {
    states.push_back(state);
    return state.now < std::chrono::seconds(3);
  });
  ASSERT_EQ(states.size(), 60u);  // 20 Hz for 3 s
  std::size_t frames = 0;
  std::int64_t counts = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const LoopState& state = states[i];
    EXPECT_EQ(state.now, std::chrono::milliseconds(50 * (i + 1)));
    EXPECT_EQ(state.devices.size(), 3u);
    EXPECT_TRUE(state.manual.autonomy);
    for (const DriveState& drive : state.heard.drive) {
      EXPECT_GE(drive.encoder_counts, counts);
      counts = drive.encoder_counts;
    }
    frames += state.heard.depth.size();
    if (!state.heard.depth.empty()) {
      ASSERT_TRUE(state.observation);
      EXPECT_EQ(state.observation->stamp, state.heard.depth.back()->stamp);
      EXPECT_EQ(state.decided, state.now);
      EXPECT_EQ(state.arbitration.driver, Driver::kAutonomy);
      EXPECT_EQ(state.arbitration.command.speed_m_s, state.decision->command.speed_m_s);
      EXPECT_EQ(state.arbitration.command.valid_for, state.decision->command.valid_for);
    }
  }
  EXPECT_NEAR(static_cast<double>(frames), 59.0, 1.0);
  EXPECT_GT(counts, 100);
}

// The plug of the twin with one device that falls silent at kFault.
class PlugThatFails final : public Plug {
 public:
  PlugThatFails(std::unique_ptr<Plug> plug, bool compass)
      : plug_(std::move(plug)), compass_(compass), muted_(plug_->robot()) {}
  PlugTraits traits() const override { return plug_->traits(); }
  Robot robot() override { return muted_.robot(); }
  std::string ReasonToEnd() override {
    const bool broken = plug_->robot().clock->Now() >= kFault;
    (compass_ ? muted_.compass.muted : muted_.depth.muted) = broken;
    return plug_->ReasonToEnd();
  }
  void Keep(Time stamp) override { plug_->Keep(stamp); }
  std::vector<std::string> Complaints() const override { return {"its lamp is dark"}; }
  std::optional<GroundTruth> Truth() override { return plug_->Truth(); }

 private:
  std::unique_ptr<Plug> plug_;
  bool compass_;
  MutedRobot muted_;
};

RunReport RunThatFails(const std::filesystem::path& out, bool compass) {
  const std::atomic<bool> not_stopped{false};
  return RunScenario(
      {.name = "corridor_short",
       .scenario = ReadScenario("corridor_short", {"duration_s=9", "checks={collisions_max: 0}"}),
       .out = out,
       .gl = Gl::kOff,
       .threads = 1,
       .pace = 0.0,
       .progress = {}},
      [=](const RunOptions& options) { return std::make_unique<PlugThatFails>(MakeTwinPlug(options), compass); },
      not_stopped);
}

TEST(SilentDeviceRun, PassesWithoutItsCompassAndSaysSoInItsNote) {
  const TemporaryFolder folder;
  const RunReport report = RunThatFails(folder.path() / "a", true);
  EXPECT_EQ(report.result.verdict, Verdict::kPass) << report.result.fault;
  EXPECT_EQ(report.result.fault, "");
  EXPECT_NE(report.note.find("the compass was silent from 4.0 s on, and the run went on without it"), std::string::npos)
      << report.note;
  EXPECT_GT(*report.result.metrics.distance_m, 2.5);
}

TEST(SilentDeviceRun, FailsWithoutItsDepthCameraAndNamesItAndItsComplaint) {
  const TemporaryFolder folder;
  const RunReport report = RunThatFails(folder.path() / "a", false);
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_EQ(report.result.fault, "the depth camera has been silent for 0.6 s (its lamp is dark)");
  EXPECT_LT(*report.result.metrics.sim_time_s, 4.0 + 0.55 + 1.0);
  EXPECT_NE(Contents(folder.path() / "a/result.json").find("the depth camera has been silent"), std::string::npos);
}

}  // namespace
}  // namespace merlin
