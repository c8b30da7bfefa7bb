#include "autonomy/unstick.h"

#include <gtest/gtest.h>

#include "autonomy/pilot.h"
#include "tests/autonomy/car.h"
#include "tests/autonomy/toy_car.h"

namespace merlin {
namespace {

constexpr double kTick_s = 0.1;

// A car at a position, with a frame that says what the test wants; each call advances time by a tenth of a second.
class Standing {
 public:
  Situation Next() {
    observation.stamp = now_ += FromSeconds(kTick_s);
    return {.now = now_,
            .observation = observation,
            .T_map_base = observation.T_odom_base,
            .local_map = map_,
            .grid = grid,
            .lost_frames = lost_frames,
            .has_map = has_map,
            .holds_position = holds_position,
            .taken_over = taken_over};
  }
  // The time until it gives up, or the limit.
  double GivesUpAfter_s(Unstick& unstick, Activity activity, double limit_s) {
    double s = 0.0;
    for (; s < limit_s && !unstick.gives_up(); s += kTick_s) unstick.Watch(Next(), activity);
    return s;
  }

  Observation observation{};
  OccupancyGrid grid{OccupancyConfig{}};
  int lost_frames = 0;
  bool has_map = true, holds_position = true, taken_over = false;

 private:
  Time now_{0};
  VoxelMap map_{VoxelMapConfig{}};
};

TEST(Unstick, GivesUpAfterFifteenSecondsOfWaiting) {
  for (const Activity activity :
       {Activity::kWaitsForObstacle, Activity::kIsLost, Activity::kWaitsForFreeGround, Activity::kSeesTooLittle}) {
    Standing car;
    Unstick unstick({});
    EXPECT_NEAR(car.GivesUpAfter_s(unstick, activity, 100.0), 15.0, 0.25) << Sentence(activity);
  }
}

TEST(Unstick, DoesNotGiveUpACarThatIsDoneTurnsWaitsForItsHeadingOrIsDrivenManually) {
  for (const Activity activity : {Activity::kIsDone, Activity::kTurnsOnTurntable, Activity::kWaitsForHeading}) {
    Standing car;
    Unstick unstick({});
    EXPECT_NEAR(car.GivesUpAfter_s(unstick, activity, 100.0), 100.0, 0.2) << Sentence(activity);
    EXPECT_FALSE(unstick.backs());
  }
  Standing car;
  car.taken_over = true;
  Unstick unstick({});
  EXPECT_NEAR(car.GivesUpAfter_s(unstick, Activity::kWaitsForObstacle, 100.0), 100.0, 0.2);
}

TEST(Unstick, ForgetsOnceTheCarHasGotAway) {
  Standing car;
  Unstick unstick({});
  for (int place = 0; place < 10; ++place) {
    for (int i = 0; i < 50; ++i) unstick.Watch(car.Next(), Activity::kWaitsForObstacle);
    EXPECT_FALSE(unstick.gives_up());
    car.observation.T_odom_base.translation().x() += 1.1;
    unstick.Watch(car.Next(), Activity::kFollowsCorridor);
    EXPECT_EQ(unstick.waited_s(), 0.0);
  }
}

TEST(Unstick, CountsOnWhereTheCarOnlyJerksBackAndForth) {
  Standing car;
  Unstick unstick({});
  double waited_s = 0.0;
  for (int i = 0; i < 10000 && !unstick.gives_up(); ++i) {
    const bool waits = i % 20 < 10;
    car.observation.T_odom_base.translation().x() = waits ? 0.0 : 0.4;
    unstick.Watch(car.Next(), waits ? Activity::kWaitsForObstacle : Activity::kFollowsCorridor);
    waited_s += waits ? kTick_s : 0.0;
  }
  EXPECT_TRUE(unstick.gives_up());
  EXPECT_NEAR(waited_s, 15.0, 0.25);
}

TEST(Unstick, BacksOnceAfterSixSecondsUntilItHasBackedFarEnough) {
  Standing car;
  Unstick unstick({});
  double s = 0.0;
  for (; !unstick.backs() && s < 100.0; s += kTick_s) unstick.Watch(car.Next(), Activity::kIsLost);
  EXPECT_NEAR(s, 6.0, 0.25);
  car.observation.T_odom_base.translation().x() = -0.39;
  unstick.Watch(car.Next(), Activity::kIsLost);
  EXPECT_TRUE(unstick.backs());
  car.observation.T_odom_base.translation().x() = -0.41;
  unstick.Watch(car.Next(), Activity::kIsLost);
  EXPECT_FALSE(unstick.backs());
  for (; !unstick.gives_up(); unstick.Watch(car.Next(), Activity::kIsLost)) EXPECT_FALSE(unstick.backs());
}

TEST(Unstick, GivesUpWhereNothingHoldsThePositionThoughTheCarDrives) {
  Standing car;
  car.holds_position = false;
  Unstick unstick({});
  EXPECT_NEAR(car.GivesUpAfter_s(unstick, Activity::kFollowsCorridor, 100.0), 15.0, 0.25);
  EXPECT_NE(WhyStuck(car.Next(), Activity::kFollowsCorridor, std::nullopt, 0.0).find("nothing to hold on to"),
            std::string::npos);

  Standing mostly_held;  // lost for a second in every three, and driving
  Unstick patient({});
  for (int i = 0; i < 10000; ++i) {
    mostly_held.lost_frames = i % 30 < 10 ? i % 30 : 0;
    patient.Watch(mostly_held.Next(), Activity::kFollowsCorridor);
  }
  EXPECT_FALSE(patient.gives_up());
}

TEST(Unstick, NamesWhatIsAtFault) {
  Standing car;
  const auto count = [&](Rejection reason) -> int& {
    return car.observation.rejections[static_cast<std::size_t>(reason)];
  };
  const auto why = [&](Activity activity, std::optional<double> free_m = {}) {
    return WhyStuck(car.Next(), activity, free_m, 15.04);
  };
  EXPECT_EQ(why(Activity::kWaitsForObstacle, 0.42), "the car had waited for 15 s: an obstacle is 0.42 m ahead");
  EXPECT_EQ(why(Activity::kSeesTooLittle),
            "the car had waited for 15 s: it sees too little to begin a map: 0 points of the frame can be used");
  count(Rejection::kNone) = 100;
  count(Rejection::kSaturated) = 300;
  EXPECT_NE(why(Activity::kSeesTooLittle).find("75 % of the depth camera's pixels are saturated"), std::string::npos);
  EXPECT_NE(why(Activity::kWaitsForObstacle, 0.0).find("75 % of"), std::string::npos);
  count(Rejection::kSaturated) = 0;
  count(Rejection::kInvalid) = count(Rejection::kLowSignal) = 450;
  EXPECT_NE(why(Activity::kIsLost).find("90 % of the depth camera's pixels get no return"), std::string::npos);
}

// A pilot whose path is blocked backs over free ground once, and then gives up and says what is ahead.
TEST(Unstick, HelpsAPilotBeforeAnObstacleAndThenGivesUp) {
  Pilot pilot(Car(), [](const Situation&) { return Intent{.speed_m_s = 0.5, .activity = Activity::kFollowsPath}; }, {});
  Standing car;
  SeeFree(car.grid, -3.0, 1.0, -1.0, 1.0);
  ToyCar toy;
  Decision decision;
  double least_x_m = 0.0, s = 0.0;
  for (; decision.gives_up.empty() && s < 60.0; s += kTick_s) {
    car.observation.points_base.clear();
    for (int i = 0; i < 20; ++i)
      car.observation.points_base.push_back(
          {.position = {static_cast<float>(0.8 - toy.x_m), 0.01f * static_cast<float>(i) - 0.1f, 0.3f},
           .sigma_m = 0.01f});
    car.observation.T_odom_base = toy.T_map_base();
    decision = pilot.Decide(car.Next());
    toy.Drive(decision.command, kTick_s);
    least_x_m = std::min(least_x_m, toy.x_m);
  }
  EXPECT_NEAR(least_x_m, -0.4, 0.06);
  EXPECT_GE(s, 15.0);
  EXPECT_LE(s, 22.0);
  EXPECT_NE(decision.gives_up.find("an obstacle is"), std::string::npos) << decision.gives_up;
  EXPECT_EQ(decision.command.speed_m_s, 0.0);
}

TEST(Unstick, NeverBacksOverGroundThatIsNotKnownToBeFree) {
  Pilot pilot(Car(), [](const Situation&) { return Intent{.speed_m_s = 0.5, .activity = Activity::kFollowsPath}; }, {});
  Standing car;
  car.lost_frames = 100;
  Decision decision;
  for (int i = 0; i < 400 && decision.gives_up.empty(); ++i) {
    decision = pilot.Decide(car.Next());
    EXPECT_EQ(decision.command.speed_m_s, 0.0);
  }
  EXPECT_NE(decision.gives_up.find("lost for 100 frames"), std::string::npos) << decision.gives_up;
}

TEST(Unstick, StandsWithoutAMap) {
  Pilot pilot(Car(), [](const Situation&) { return Intent{.speed_m_s = 0.5, .activity = Activity::kFollowsPath}; }, {});
  Standing car;
  car.has_map = false;
  const Decision decision = pilot.Decide(car.Next());
  EXPECT_EQ(decision.command.speed_m_s, 0.0);
  EXPECT_EQ(decision.activity, Activity::kSeesTooLittle);
}

}  // namespace
}  // namespace merlin
