// Runs that start in the map of an earlier run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "scenarios/judge/tum_file.h"
#include "scenarios/run/plugs.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

const std::atomic<bool> never_stop{false};

RunReport Drive(const std::filesystem::path& out, const std::vector<std::string>& sets) {
  RunOptions options;
  options.name = "corridor_short";
  options.scenario = ReadScenario("corridor_short", sets);
  options.out = out;
  options.gl = Gl::kOff;
  return RunScenario(options, never_stop);
}

Pose LastPose(const std::filesystem::path& tum) {
  return ParseTum(ReadFile(tum, "a trajectory"), tum.string()).trajectory.back().T;
}

class StartInMap : public testing::Test {
 protected:
  // The first run begins here, and so does its map: along the room's axes, as the compass has them.
  static constexpr double kFirstX_m = 0.0, kFirstY_m = -9.5;

  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    Drive(folder_->path() / "first", {"duration_s=16"});
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::filesystem::path Folder() { return folder_->path(); }
  static std::string Map() { return "map=" + (Folder() / "first/map.slam").string(); }

 private:
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(StartInMap, KnowsItsPlaceWithinTenSecondsAndFiveMetresAndMapsOnInTheSameFrame) {
  const auto out = Folder() / "again";
  const RunReport report = Drive(out, {Map(), "car.start.x_m=2.3", "car.start.y_m=-9.3", "duration_s=13", "checks={}"});
  const Metrics& m = report.result.metrics;
  EXPECT_EQ(report.result.fault, "");
  ASSERT_TRUE(m.place_found_s);
  EXPECT_LE(*m.place_found_s, 10.0);
  EXPECT_LE(*m.place_found_m, 5.0);
  const Pose T_world_map = FromXyYaw(kFirstX_m, kFirstY_m, 0.0);
  const Pose error =
      (T_world_map * LastPose(out / "trajectory_estimate.tum")).inverse() * LastPose(out / "trajectory_truth.tum");
  EXPECT_LT(error.translation().head<2>().norm(), 0.15);
  EXPECT_LT(std::abs(Yaw(error)), 0.05);
  EXPECT_LT(*m.ate_rmse_m, 0.1);  // the path before the place was found is in the same frame
  // Its own map holds both runs.
  const SavedMap first = ReadSavedMap(Folder() / "first/map.slam"), both = ReadSavedMap(out / "map.slam");
  EXPECT_GT(both.keyframes.size(), first.keyframes.size());
  EXPECT_EQ(std::ranges::count(both.keyframes, true, &Keyframe::first_of_run), 2);
  EXPECT_GE(both.loops.size(), 1u);
}

TEST_F(StartInMap, SaysThatItDoesNotKnowAForeignPlaceAndEnds) {
  const RunReport report =
      Drive(Folder() / "foreign", {Map(), "room=room_7x10", "car.start={x_m: 0, y_m: 0, yaw_rad: 0}",
                                   "slam.search.give_up_s=6", "duration_s=15", "checks={}"});
  EXPECT_EQ(report.result.verdict, Verdict::kFail);
  EXPECT_NE(report.result.fault.find("the car does not know this place in map "), std::string::npos)
      << report.result.fault;
  EXPECT_LT(*report.result.metrics.sim_time_s, 12.0);
  EXPECT_FALSE(report.result.metrics.place_found_s);
}

TEST_F(StartInMap, RefusesADamagedMapAndAFolderThatHoldsItBeforeAnythingIsWritten) {
  std::string bytes = ReadFile(Folder() / "first/map.slam", "a map");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  WriteFile(Folder() / "damaged.slam", bytes);
  const auto out = Folder() / "refused";
  EXPECT_THROW(Drive(out, {"map=" + (Folder() / "damaged.slam").string()}), InputError);
  EXPECT_THROW(Drive(out, {"map=" + (Folder() / "none.slam").string()}), InputError);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_THROW(Drive(Folder() / "first", {Map()}), InputError);
  EXPECT_TRUE(std::filesystem::exists(Folder() / "first/map.slam"));
}

}  // namespace
}  // namespace merlin
