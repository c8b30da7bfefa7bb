// Faults in the middle of a run: the car stops, the reason is reported, the remaining files are written.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "robot/twin/twin.h"
#include "scenarios/run/drive_loop.h"
#include "scenarios/run/plugs.h"
#include "tests/sim/world/car_world.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

std::atomic<bool> never_stop{false};

constexpr char kCorridor[] = R"(<geom name="floor" type="plane" size="0 0 1"/>
  <geom type="box" size="20 .1 1" pos="0 1.1 1"/> <geom type="box" size="20 .1 1" pos="0 -1.1 1"/>)";

// The twin's devices, each with a hook that may throw before it is used.
using Hook = std::function<void()>;

struct HookedDepth final : DepthCamera {
  HookedDepth(DepthCamera& camera, Hook before_poll) : inner(camera), hook(std::move(before_poll)) {}
  const DepthCameraInfo& Info() const override { return inner.Info(); }
  void Configure(const DepthSettings& settings) override { inner.Configure(settings); }
  std::optional<DepthFrame> Poll() override { return hook(), inner.Poll(); }
  DeviceStatus Status() const override { return inner.Status(); }
  DepthCamera& inner;
  Hook hook;
};

struct HookedCompass final : Compass {
  HookedCompass(Compass& compass, Hook before_poll) : inner(compass), hook(std::move(before_poll)) {}
  std::optional<CompassReading> Poll() override { return hook(), inner.Poll(); }
  DeviceStatus Status() const override { return inner.Status(); }
  Compass& inner;
  Hook hook;
};

struct HookedDrive final : Drive {
  HookedDrive(Drive& drive, Hook before_poll, Hook before_send)
      : inner(drive), poll_hook(std::move(before_poll)), send_hook(std::move(before_send)) {}
  void Send(const DriveCommand& command) override { last = command, send_hook(), inner.Send(command); }
  std::optional<DriveState> Poll() override { return poll_hook(), inner.Poll(); }
  DeviceStatus Status() const override { return inner.Status(); }
  Drive& inner;
  Hook poll_hook, send_hook;
  DriveCommand last;
};

struct HookedClock final : Clock {
  HookedClock(Clock& clock, Hook before_wait) : inner(clock), hook(std::move(before_wait)) {}
  Time Now() const override { return inner.Now(); }
  bool WaitUntil(Time time) override { return hook(), inner.WaitUntil(time); }
  Clock& inner;
  Hook hook;
};

class BrokenRun : public ::testing::Test {
 protected:
  BrokenRun() : room_("room.xml", sim::Room(kCorridor)) {
    TwinOptions options;
    options.world.room = room_.path();
    options.world.car = sim::Merlin();
    options.depth.sheet =
        ReadDepthCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
    options.compass = TwinOptions::Compass{};
    options.end = std::chrono::seconds(20);
    options.threads = 1;
    twin_.emplace(options);
  }

  // Throws this from the third second of the run on.
  template <class Thrown>
  Hook Late(Thrown thrown) {
    return [this, thrown] {
      if (twin_->robot().clock->Now() > std::chrono::seconds(3)) throw thrown;
    };
  }
  // Drives ahead by manual command until something throws. Returns type and text of the exception.
  std::string Drive(
      const Hook& depth, const Hook& compass, const Hook& poll, const Hook& send, const Hook& wait,
      const Hook& observe = [] {}) {
    Robot robot = twin_->robot();
    HookedDepth hooked_depth(*robot.depth, depth);
    HookedCompass hooked_compass(*robot.compass, compass);
    HookedDrive hooked_drive(*robot.drive, poll, send);
    HookedClock hooked_clock(*robot.clock, wait);
    robot.depth = &hooked_depth, robot.compass = &hooked_compass, robot.drive = &hooked_drive,
    robot.clock = &hooked_clock;
    DriveLoop loop(robot, sim::Merlin(), {}, {}, {}, {});
    const auto manual = [&](Time now) {
      fastest_m_s_ = std::max(fastest_m_s_, twin_->world().Speed_m_s());
      return ManualCommand{.heard = now, .held = true, .speed_m_s = 0.8};
    };
    std::string thrown;
    try {
      const auto watch = [&](const LoopState&) { return observe(), true; };
      loop.Run(never_stop, watch, manual);
    } catch (const DeviceError& error) {
      thrown = std::string("device: ") + error.what();
    } catch (const MachineError& error) {
      thrown = std::string("machine: ") + error.what();
    } catch (const std::exception& error) {
      thrown = std::string("ours: ") + error.what();
    }
    last_ = hooked_drive.last;
    return thrown;
  }
  void ExpectStanding() {
    EXPECT_GT(fastest_m_s_, 0.5) << "it did not drive";
    EXPECT_EQ(last_.speed_m_s, 0.0);
    EXPECT_LT(std::abs(twin_->world().Speed_m_s()), 0.01);
    EXPECT_LT(Seconds(twin_->robot().clock->Now()), 3.0 + 3.2);
  }

  sim::TemporaryFile room_;
  std::optional<Twin> twin_;
  double fastest_m_s_ = 0.0;
  DriveCommand last_;
  Hook well_ = [] {};
};

TEST_F(BrokenRun, StandsWhenTheDepthCameraThrows) {
  EXPECT_EQ(Drive(Late(std::runtime_error("no light")), well_, well_, well_, well_), "device: depth camera: no light");
  ExpectStanding();
}

TEST_F(BrokenRun, StandsWhenADeviceThrowsSomethingOtherThanAnException) {
  EXPECT_EQ(Drive(well_, Late(42), well_, well_, well_), "device: compass: its driver threw an unknown exception");
  ExpectStanding();
}

TEST_F(BrokenRun, StandsWhenTheDriveNoLongerTellsItsState) {
  EXPECT_EQ(Drive(well_, well_, Late(MachineError("unplugged")), well_, well_), "device: drive: unplugged");
  ExpectStanding();
}

// Time after which the last command has expired.
TEST_F(BrokenRun, StandsWhenTheDriveNoLongerTakesCommands) {
  EXPECT_EQ(Drive(well_, well_, well_, Late(std::runtime_error("deaf")), well_), "device: drive: deaf");
  ExpectStanding();
}

TEST_F(BrokenRun, StandsWhenTheObserverThrows) {
  EXPECT_EQ(Drive(well_, well_, well_, well_, well_, Late(MachineError("disk full"))), "machine: disk full");
  ExpectStanding();
}

TEST_F(BrokenRun, SendsAStopWhenTheWorldIsNoLongerSteppable) {
  EXPECT_EQ(Drive(well_, well_, well_, well_, Late(std::runtime_error("bad state"))), "ours: bad state");
  EXPECT_GT(fastest_m_s_, 0.5);
  EXPECT_EQ(last_.speed_m_s, 0.0);
}

TEST_F(BrokenRun, TellsTheFirstFaultOfSeveral) {
  EXPECT_EQ(Drive(well_, well_, Late(std::runtime_error("second")), well_, well_, Late(std::logic_error("third"))),
            "device: drive: second");  // the drive is asked before the frame is shown
}

// A scenario in a room that the test makes.
RunOptions OptionsFor(const std::filesystem::path& room, const std::filesystem::path& out, double duration_s) {
  RunOptions options{
      .name = "broken",
      .scenario = ReadScenario("corridor_short", {"room=" + room.string(), "car.start.y_m=0", "checks={}", "seed=3",
                                                  "duration_s=" + std::to_string(duration_s)}),
      .out = out,
      .progress = {}};
  options.gl = Gl::kOff;
  return options;
}

std::string What(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const InputError& what) {
    return std::string("input: ") + what.what();
  } catch (const DeviceError& what) {
    return std::string("device: ") + what.what();
  } catch (const MachineError& what) {
    return std::string("machine: ") + what.what();
  } catch (const std::exception& what) {
    return std::string("ours: ") + what.what();
  }
  return "";
}

// A body far above, pushed up by a force proportional to its displacement: e^(4 t), 1e9 m after five seconds.
constexpr char kRunaway[] = R"(<body pos="0 0 50">
    <joint type="slide" axis="0 0 1" stiffness="-16" springref="-1" damping="0"/><geom type="sphere" size=".1" mass="1"/></body>)";

TEST(BadState, EndsTheRunAsOurOwnFaultWithEveryFile) {
  const TemporaryFolder folder;
  const sim::TemporaryFile room("room.xml", sim::Room(std::string(kCorridor) + kRunaway));
  const RunReport report = RunScenario(OptionsFor(room.path(), folder.path() / "a", 10), never_stop);
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_TRUE(What(report.error).starts_with("ours: MuJoCo stopped at ")) << What(report.error);
  EXPECT_TRUE(report.result.fault.starts_with("MuJoCo stopped at ")) << report.result.fault;
  EXPECT_GT(*report.result.metrics.sim_time_s, 1.0);
  EXPECT_LT(*report.result.metrics.sim_time_s, 9.0);
  EXPECT_TRUE(report.result.metrics.ate_rmse_m);
  for (const char* name :
       {"result.json", "junit.xml", "scenario.yaml", "trajectory_estimate.tum", "trajectory_online.tum",
        "trajectory_truth.tum", "map.ply", "map.pgm", "map.yaml", "map.png", "map.slam"})
    EXPECT_GT(std::filesystem::file_size(folder.path() / "a" / name), 0u) << name;
  for (const char* name : {"result.json", "junit.xml"})
    EXPECT_NE(Contents(folder.path() / "a" / name).find("MuJoCo stopped at "), std::string::npos) << name;
  EXPECT_NE(Contents(folder.path() / "a/result.json").find("\"verdict\": \"fail\""), std::string::npos);
}

// For large files, a limit on the file size acts like a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_;
  sighandler_t handler_;
};

TEST(FullDisk, LosesOnlyTheFilesThatDoNotFit) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "a";
  RunOptions options = OptionsFor("corridor_26x21", out, 4);
  options.scenario.car.start.y_m = -9.5;
  RunReport report;
  {
    const FileSizeLimit limit(16'000);
    report = RunScenario(options, never_stop);
  }
  const std::string reason = (out / "map.ply").string() + ": cannot be written: File too large";
  EXPECT_EQ(What(report.error), "machine: " + reason);
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_NE(Contents(out / "result.json").find(reason), std::string::npos);
  EXPECT_NE(Contents(out / "junit.xml").find("map.ply"), std::string::npos);
  EXPECT_FALSE(report.result.hashes.map);
  EXPECT_TRUE(report.result.hashes.trajectory);
  for (const char* name : {"trajectory_estimate.tum", "trajectory_online.tum", "trajectory_truth.tum"})
    EXPECT_GT(std::filesystem::file_size(out / name), 0u) << name;
  EXPECT_FALSE(std::filesystem::exists(out / "map.ply"));
  EXPECT_FALSE(std::filesystem::exists(out / "map.ply.part"));
}

TEST(Progress, DoesNotStopTheCarWhereNobodyReadsIt) {
  const TemporaryFolder folder;
  const sim::TemporaryFile room("room.xml", sim::Room(kCorridor));
  RunOptions options = OptionsFor(room.path(), folder.path() / "a", 1);
  int calls = 0;
  options.pace = 4.0;
  options.progress = [&calls](const LoopState&) {
    ++calls;
    throw std::runtime_error("cannot write to file");
  };
  const RunReport report = RunScenario(options, never_stop);
  EXPECT_GT(calls, 0);
  EXPECT_EQ(report.result.verdict, Verdict::kNotJudged) << report.result.fault;
}

// Drives by manual command out of a room that is open at its end.
TEST(LostCar, FailsTheRunWithTheReason) {
  const TemporaryFolder folder;
  const sim::TemporaryFile room("room.xml",
                                sim::Room(std::string(sim::kPlane) + R"(<geom type="box" size="1 .1 1" pos="0 1.1 1"/>
                                                                                   <geom type="box" size="1 .1 1" pos="0 -1.1 1"/>)"));
  RunOptions options = OptionsFor(room.path(), folder.path() / "a", 20);
  options.manual = [](Time now) {
    return ManualCommand{.heard = now, .held = true, .speed_m_s = 0.8, .override_stop = true};
  };
  const RunReport report = RunScenario(options, never_stop);
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_FALSE(report.error);
  EXPECT_NE(report.result.fault.find("s the car left the room: it was at x 2.00 m, y "), std::string::npos)
      << report.result.fault;
  EXPECT_NEAR(*report.result.metrics.distance_m, 2.0, 0.5);  // plus the stopping distance
  EXPECT_NE(Contents(folder.path() / "a/result.json").find(report.result.fault), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "a/map.ply"));
}

}  // namespace
}  // namespace merlin
