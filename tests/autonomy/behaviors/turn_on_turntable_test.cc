#include "autonomy/behaviors/turn_on_turntable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace merlin {
namespace {

using std::numbers::pi;

// What the behaviour returns while the turntable turns from one angle to the next, in steps of at most 0.1 rad.
Intent After(TurnOnTurntable& behavior, double from_rad, double to_rad) {
  const VoxelMap map({});
  const OccupancyGrid grid({});
  Observation observation;
  Intent intent;
  const int steps = static_cast<int>(std::ceil(std::abs(to_rad - from_rad) / 0.1)) + 1;
  for (int i = 0; i <= steps; ++i) {
    observation.T_odom_base = FromXyYaw(0.0, 0.0, WrapPi(from_rad + (to_rad - from_rad) * i / steps));
    intent =
        behavior.Decide({.observation = observation, .T_map_base = Pose::Identity(), .local_map = map, .grid = grid});
  }
  return intent;
}

TEST(TurnOnTurntable, IsDoneAfterItsAngleAndNotBefore) {
  for (const double angle_rad : {pi, -2.0 * pi, 5.0 * pi}) {  // all of them wrap
    TurnOnTurntable behavior({.angle_rad = angle_rad});
    const Intent turning = After(behavior, 0.0, 0.99 * angle_rad);
    EXPECT_FALSE(turning.done);
    EXPECT_EQ(turning.activity, Activity::kTurnsOnTurntable);
    EXPECT_EQ(turning.turntable_rad, angle_rad);
    EXPECT_EQ(turning.speed_m_s, 0.0);
    EXPECT_TRUE(turning.path_map.empty());
    const Intent done = After(behavior, 0.99 * angle_rad, angle_rad);
    EXPECT_TRUE(done.done);
    EXPECT_EQ(done.activity, Activity::kIsDone);
  }
}

TEST(TurnOnTurntable, CountsFromWhereItBegan) {
  TurnOnTurntable behavior({.angle_rad = 1.0});
  EXPECT_FALSE(After(behavior, 3.0, 3.9).done);
  EXPECT_TRUE(After(behavior, 3.9, 4.0).done);
}

TEST(TurnOnTurntable, IsDoneAtOnceWithNothingToTurn) {
  TurnOnTurntable behavior({.angle_rad = 0.0});
  EXPECT_TRUE(After(behavior, 0.5, 0.5).done);
}

}  // namespace
}  // namespace merlin
