#include "autonomy/behaviors/table.h"

#include <gtest/gtest.h>

#include <set>

namespace merlin {
namespace {

TEST(BehaviorTable, HasANameASentenceAndAFactoryInEachRow) {
  std::set<std::string> names;
  for (const BehaviorInfo& behavior : Behaviors()) {
    EXPECT_TRUE(names.insert(behavior.name).second) << behavior.name;
    EXPECT_TRUE(behavior.former_name.empty() || names.insert(behavior.former_name).second) << behavior.former_name;
    EXPECT_TRUE(behavior.description.ends_with('.')) << behavior.name;
    EXPECT_TRUE(behavior.make({}, {})) << behavior.name;
  }
  EXPECT_EQ(BehaviorNames().size(), Behaviors().size());
}

TEST(BehaviorTable, FindsFormerNames) {
  ASSERT_NE(FindBehavior("turn_on_stand"), nullptr);
  EXPECT_EQ(FindBehavior("turn_on_stand")->name, "turn_on_turntable");
  EXPECT_EQ(FindBehavior("follow_corridor")->name, "follow_corridor");
  EXPECT_EQ(FindBehavior(""), nullptr);
  EXPECT_EQ(FindBehavior("fly"), nullptr);
}

TEST(BehaviorTable, KnowsWhatNeedsATurntable) {
  EXPECT_TRUE(IsOnTurntable({.behavior = "turn_on_turntable"}));
  EXPECT_FALSE(IsOnTurntable({.behavior = "follow_corridor"}));
  EXPECT_FALSE(IsOnTurntable({.behavior = "fly"}));
}

TEST(BehaviorTable, HandsTheTaskToTheBehavior) {
  const VoxelMap map({});
  const OccupancyGrid grid({});
  const Observation observation;
  const Situation situation{.observation = observation, .T_map_base = Pose::Identity(), .local_map = map, .grid = grid};
  const Task task{.behavior = "turn_on_turntable", .angle_deg = -90.0};
  EXPECT_DOUBLE_EQ(*FindBehavior(task.behavior)->make(task, {})(situation).turntable_rad, -1.5707963267948966);
  BehaviorConfig slow;
  slow.follow_corridor.speed_m_s = 0.1;
  EXPECT_EQ(FindBehavior("follow_corridor")->make({}, slow)(situation).speed_m_s, 0.1);
}

}  // namespace
}  // namespace merlin
