// The car backs in the twin: over ground that its own map knows, and no farther.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "autonomy/pilot.h"
#include "perception/pipeline.h"
#include "robot/description/description.h"
#include "robot/twin/twin.h"
#include "slam/slam.h"
#include "tests/sim/world/car_world.h"

namespace merlin {
namespace {

// A hall of 8.5 x 7.5 m: all of it within the range of the camera. The car starts at its origin and looks along x.
constexpr char kHall[] = R"(<geom name="floor" type="plane" size="20 20 1"/>
  <geom type="box" size="0.1 4 1" pos="7.6 -2.25 1"/> <geom type="box" size="0.1 4 1" pos="-1.1 -2.25 1"/>
  <geom type="box" size="6 0.1 1" pos="4.5 1.6 1"/> <geom type="box" size="6 0.1 1" pos="4.5 -6.1 1"/>)";

// The same, but the wall ahead of the start stands nearer: its face is at x = 4.3.
constexpr char kShortHall[] = R"(<geom name="floor" type="plane" size="20 20 1"/>
  <geom name="wall" type="box" size="0.1 4 1" pos="4.4 -2.25 1"/> <geom type="box" size="0.1 4 1" pos="-1.1 -2.25 1"/>
  <geom type="box" size="3 0.1 1" pos="1.5 1.6 1"/> <geom type="box" size="3 0.1 1" pos="1.5 -6.1 1"/>)";

using Path = std::vector<Eigen::Vector2d>;

// Continues a path straight to a point.
void AddLine(Path& path, double x, double y) {
  const Eigen::Vector2d from = path.back(), step = Eigen::Vector2d(x, y) - from;
  const int parts = static_cast<int>(std::ceil(step.norm() / 0.05));
  for (int i = 1; i <= parts; ++i) path.push_back(from + step * i / parts);
}

// Continues a path that leads along x by a half circle to the right.
void AddHalfCircle(Path& path, double radius_m) {
  const Eigen::Vector2d centre = path.back() - Eigen::Vector2d(0.0, radius_m);
  for (double angle = 0.05 / radius_m; angle < std::numbers::pi; angle += 0.05 / radius_m)
    path.push_back(centre + radius_m * Eigen::Vector2d(std::sin(angle), std::cos(angle)));
}

// Drives one path to its end, then backs along another.
class ThereAndBack {
 public:
  ThereAndBack(Path there, Path back) : there_(std::move(there)), back_(std::move(back)) {}
  Intent Decide(const Situation& situation) {
    const Eigen::Vector2d here = situation.T_map_base->translation().head<2>();
    backs_ = backs_ || (here - there_.back()).norm() < 0.1;
    Intent intent{.speed_m_s = 0.4, .activity = Activity::kFollowsCorridor};
    intent.path_map = backs_ ? back_ : there_;
    if (!backs_) return intent;
    intent.direction = Direction::kBackwards;
    intent.activity = Activity::kBacks;
    return intent;
  }

 private:
  Path there_, back_;
  bool backs_ = false;
};

// Infinite in a room without a geom of this name.
double DistanceToGeom_m(const sim::World& world, const char* name) {
  double distance_m = HUGE_VAL;
  const int other = mj_name2id(world.model(), mjOBJ_GEOM, name);
  for (int geom = 0; other >= 0 && geom < world.model()->ngeom; ++geom)
    if (world.IsCarGeom(geom))
      distance_m = std::min(
          distance_m, mj_geomDistance(world.model(), const_cast<mjData*>(world.data()), geom, other, 10.0, nullptr));
  return distance_m;
}

class Backing : public ::testing::Test {
 protected:
  // The twin's car, driven by its own perception, map and pilot.
  void Drive(const Path& there, const Path& back, double seconds, const char* hall = kHall) {
    const sim::TemporaryFile room("room.xml", sim::Room(hall));
    TwinOptions options;
    options.world.room = room.path();
    options.world.car = sim::Merlin();
    options.depth.sheet =
        ReadDepthCameraSheet(std::filesystem::path(MERLIN_SOURCE_DIR) / "models/cameras/pmd_3k_s.yaml");
    options.compass = TwinOptions::Compass{};
    options.end = FromSeconds(seconds);
    options.threads = 1;
    Twin twin(options);
    const Robot robot = twin.robot();
    const DepthCameraInfo& depth = robot.depth->Info();
    Pipeline pipeline({.car = sim::Merlin(), .depth = depth.sheet, .T_base_depth = depth.T_base_camera, .color = {}},
                      {});
    Slam slam({}, FootprintOf(sim::Merlin()));
    ThereAndBack behavior(there, back);
    Pilot pilot(sim::Merlin(), [&](const Situation& situation) { return behavior.Decide(situation); }, {});
    while (robot.clock->WaitUntil(robot.clock->Now() + std::chrono::milliseconds(50))) {
      while (const auto state = robot.drive->Poll()) pipeline.Add(*state);
      while (const auto reading = robot.compass->Poll()) pipeline.Add(*reading);
      while (auto frame = robot.depth->Poll()) {
        const auto observation = pipeline.Process(std::move(*frame));
        if (!observation) continue;
        const auto T_map_base = slam.Update(*observation);
        decision_ = pilot.Decide({.now = robot.clock->Now(),
                                  .observation = *observation,
                                  .T_map_base = T_map_base,
                                  .local_map = slam.local_map(),
                                  .grid = slam.occupancy(),
                                  .lost_frames = slam.lost_frames()});
        robot.drive->Send(decision_.command);
      }
      Watch(twin.world());
    }
  }
  void Watch(sim::World& world) {
    const Pose T_world_base = world.T_world_base();
    here_ = T_world_base.translation().head<2>();
    if (decision_.command.speed_m_s >= 0.0 && backed_m_ == 0.0) turned_back_ = here_;
    if (decision_.command.speed_m_s < 0.0) backed_m_ = (here_ - turned_back_).norm();
    fastest_back_m_s_ = std::max(fastest_back_m_s_, -world.Speed_m_s());
    wall_m_ = DistanceToGeom_m(world, "wall");
    nearest_wall_m_ = std::min(nearest_wall_m_, wall_m_);
    touches_ += world.CarTouches().size();
  }

  Decision decision_;
  Eigen::Vector2d here_{0, 0}, turned_back_{0, 0};  // position, and where it began to back
  double backed_m_ = 0.0;
  double fastest_back_m_s_ = 0.0;
  double wall_m_ = HUGE_VAL, nearest_wall_m_ = HUGE_VAL;  // true distance of the wall that has a name
  std::size_t touches_ = 0;
};

TEST_F(Backing, BacksHalfAMetreOverGroundItHasSeen) {
  Path there{{0.0, 0.0}}, back{{3.0, 0.0}};
  AddLine(there, 3.0, 0.0);
  AddLine(back, 2.4, 0.0);
  Drive(there, back, 16.0);
  EXPECT_NEAR(here_.x(), 2.4, 0.06);
  EXPECT_NEAR(here_.y(), 0.0, 0.05);
  EXPECT_LT(fastest_back_m_s_, BackConfig{}.speed_max_m_s + 0.03);
  EXPECT_GT(fastest_back_m_s_, 0.1);
  EXPECT_EQ(decision_.activity, Activity::kBacks);
}

TEST_F(Backing, StopsWhereItHasSeenNoGround) {
  Path there{{0.0, 0.0}}, back{{3.0, 0.0}};
  AddLine(there, 3.0, 0.0);
  AddLine(back, -2.0, 0.0);
  Drive(there, back, 40.0);
  EXPECT_EQ(decision_.activity, Activity::kWaitsForFreeGround) << decision_.doing;
  EXPECT_EQ(decision_.command.speed_m_s, 0.0);
  EXPECT_GT(backed_m_, 0.5);
  // Behind its start it knows nothing: its rear stays ahead of where it was then.
  EXPECT_GT(here_.x() - FootprintOf(sim::Merlin()).rear_m, 0.0);
}

// It turns around before the wall, then backs towards it: over ground that it saw before it turned, and over the path that
// it drove and never looked at.
TEST_F(Backing, StopsBeforeAWallBehindIt) {
  Path there{{0.0, 0.0}};
  AddLine(there, 2.2, 0.0);
  AddHalfCircle(there, 1.0);
  AddLine(there, 1.5, -2.0);
  Path back{{1.5, -2.0}};
  AddLine(back, 8.0, -2.0);
  Drive(there, back, 40.0, kShortHall);
  EXPECT_EQ(decision_.activity, Activity::kWaitsForFreeGround) << decision_.doing;
  EXPECT_LT(turned_back_.x(), 2.0) << "it came from beyond the turn, and backs over all of it";
  EXPECT_GT(backed_m_, 2.0);
  EXPECT_GE(nearest_wall_m_, 0.05);
  EXPECT_LT(wall_m_, 0.3) << "it backs as far as it can";
  EXPECT_EQ(touches_, 0u);
}

}  // namespace
}  // namespace merlin
