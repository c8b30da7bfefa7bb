#include "scenarios/judge/tum_file.h"

#include <gtest/gtest.h>

#include "robot/base/error.h"
#include "scenarios/judge/writers.h"
#include "tests/support/mutate.h"

namespace merlin {
namespace {

const std::string kTwo = "# stamp x y z qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\n2.000000001 4 5 6 0 0 0 1\n";

void ExpectTumRefused(const std::string& text, const std::string& part) {
  try {
    ParseTum(text, "t.tum");
    ADD_FAILURE() << "taken: " << text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << "\n" << part;
  }
}

TEST(TumFile, ReadsStampsAndPoses) {
  const TumFile file = ParseTum(kTwo, "t.tum");
  ASSERT_EQ(file.trajectory.size(), 2u);
  EXPECT_TRUE(file.warnings.empty());
  EXPECT_EQ(file.trajectory[0].stamp, Time(1'500'000'000));
  EXPECT_EQ(file.trajectory[1].stamp, Time(2'000'000'001));
  EXPECT_EQ(file.trajectory[0].T.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(Yaw(file.trajectory[0].T), 2.0 * std::atan2(0.6, 0.8), 1e-15);
}

TEST(TumFile, ReadsWhatIsWritten) {
  Trajectory trajectory;
  for (int i = 0; i < 50; ++i)
    trajectory.push_back(
        {Time(1'000'000'000 + 50'000'001LL * i), Exp((Vector6d() << i, -i, 0.1, 0.1 * i, 0.2, -0.1 * i).finished())});
  const TumFile file = ParseTum(ToTum(trajectory), "t.tum");
  ASSERT_EQ(file.trajectory.size(), trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(file.trajectory[i].stamp, trajectory[i].stamp);
    EXPECT_LT((file.trajectory[i].T.matrix() - trajectory[i].T.matrix()).norm(), 1e-8);
  }
}

TEST(TumFile, TakesExponentsTabsWindowsLinesAndNoLastNewline) {
  const TumFile file = ParseTum("1.305031102175304890e+09\t1 2 3 0 0 0 1\r\n\r\n 1305031103 1 2 3 0 0 0 1 ", "t.tum");
  ASSERT_EQ(file.trajectory.size(), 2u);
  EXPECT_NEAR(Seconds(file.trajectory[1].stamp - file.trajectory[0].stamp), 0.824695, 1e-6);
}

TEST(TumFile, RefusesWithTheLine) {
  ExpectTumRefused("", "t.tum: no poses");
  ExpectTumRefused("# nothing\n\n", "t.tum: no poses");
  ExpectTumRefused(kTwo + "1.9 4 5 6 0 0 0 1\n",
                   "t.tum:4: the stamp comes before the one above it; expected 2.000000001 s");
  ExpectTumRefused(kTwo + "3 4 5 6 0 0 0\n", "t.tum:4: the line ends before the quaternion");
  ExpectTumRefused(kTwo + "3 4 5 6 0 0 0 1 9\n", "t.tum:4: more fields");
  ExpectTumRefused(kTwo + "3,4,5,6,0,0,0,1\n", "t.tum:4: the stamp; expected a number");
  ExpectTumRefused(kTwo + "nan 4 5 6 0 0 0 1\n", "t.tum:4: the stamp");
  ExpectTumRefused(kTwo + "3 4 inf 6 0 0 0 1\n", "t.tum:4: the position");
  ExpectTumRefused(kTwo + "3 4 5 6 0 0 nan 1\n", "t.tum:4: the quaternion");
  ExpectTumRefused(kTwo + "3 4 5 6 0 0 0 0\n", "t.tum:4: a quaternion of no length");
  ExpectTumRefused(kTwo + "1e12 4 5 6 0 0 0 1\n", "t.tum:4: the stamp");
}

TEST(TumFile, NamesEveryFaultAtOnce) {
  ExpectTumRefused(kTwo + "3 4 5\n1 4 5 6 0 0 0 1\nx\n4 4 5 6 0 0 0 1 1\n",
                   "t.tum:4: the line ends before the position\n"
                   "t.tum:5: the stamp comes before the one above it; expected "
                   "2.000000001 s or more, got 1.000000000 s\nt.tum:6: the stamp; expected a number between -9e+09 and "
                   "9e+09, got 'x'\nt.tum:7: more fields than");
}

TEST(TumFile, IgnoresAByteOrderMark) {
  for (const std::string& text : {kTwo, kTwo.substr(kTwo.find('\n') + 1)}) {
    const TumFile file = ParseTum("\xEF\xBB\xBF" + text, "t.tum");
    EXPECT_EQ(ToTum(file.trajectory), ToTum(ParseTum(kTwo, "t.tum").trajectory));
    EXPECT_TRUE(file.warnings.empty());
  }
}

TEST(TumFile, TakesEqualStampsWithAWarning) {
  const TumFile file = ParseTum(kTwo + "2.000000001 4 5 7 0 0 0 1\n2.000000001 4 5 8 0 0 0 1\n", "t.tum");
  EXPECT_EQ(file.trajectory.size(), 4u);
  EXPECT_EQ(file.warnings, std::vector<std::string>{"t.tum: 2 stamps are that of the pose above; all its poses are "
                                                    "taken, and paired as evo does (lines 4, 5)"});
}

TEST(TumFile, NamesQuaternionsOffUnitLength) {
  const TumFile file = ParseTum("1 0 0 0 0 0 1.2 1.6\n2 0 0 0 0 0 0 1\n", "t.tum");
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_EQ(file.warnings[0], "t.tum: 1 quaternion off unit length, normalised (line 1)");
  EXPECT_TRUE(file.trajectory[0].T.linear().isUnitary(1e-14));
}

TEST(TumFile, SurvivesBrokenTexts) {
  Mutator mutator(1);
  int taken = 0;
  for (int i = 0; i < 50000; ++i) {
    const std::string text = mutator.Mutated(kTwo);
    try {
      const Trajectory trajectory = ParseTum(text, "t.tum").trajectory;
      ++taken;
      EXPECT_FALSE(trajectory.empty());
      for (const StampedPose& pose : trajectory) EXPECT_TRUE(pose.T.matrix().allFinite()) << text;
      PairAtNearestStamps(trajectory, trajectory, Duration(0));
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with("t.tum")) << error.what();
    }
  }
  EXPECT_GT(taken, 1000);
}

// One pose for each stamp [ms]; its x [m] is its index.
Trajectory StampedAt(const std::vector<int>& stamps_ms) {
  Trajectory trajectory;
  for (const int stamp_ms : stamps_ms)
    trajectory.push_back(
        {std::chrono::milliseconds(stamp_ms), FromXyYaw(static_cast<double>(trajectory.size()), 0.0, 0.0)});
  return trajectory;
}

using Indices = std::vector<std::pair<int, int>>;

Indices Paired(const std::vector<int>& truth_ms, const std::vector<int>& estimate_ms, int difference_ms) {
  Indices indices;
  for (const PosePair& pair :
       PairAtNearestStamps(StampedAt(truth_ms), StampedAt(estimate_ms), std::chrono::milliseconds(difference_ms)))
    indices.emplace_back(pair.T_world_base.translation().x(), pair.T_map_base.translation().x());
  return indices;
}

TEST(PairAtNearestStamps, PairsEachOfTheShorterWithTheNearest) {
  EXPECT_EQ(Paired({0, 10, 20, 30, 40}, {1, 19, 36}, 5), (Indices{{0, 0}, {2, 1}, {4, 2}}));
  EXPECT_EQ(Paired({1, 19, 36}, {0, 10, 20, 30, 40}, 5), (Indices{{0, 0}, {1, 2}, {2, 4}}));
  EXPECT_EQ(Paired({0, 10, 20}, {5, 100}, 5),
            (Indices{{0, 0}}));  // the earlier of two equally near ones; the limit itself counts
  EXPECT_EQ(Paired({0, 10, 20}, {5, 100}, 4), Indices{});
  EXPECT_EQ(Paired({10, 20}, {-3, 40}, 20), (Indices{{0, 0}, {1, 1}}));  // beyond either end
  EXPECT_EQ(Paired({}, {1}, 5), Indices{});
  EXPECT_EQ(Paired({1}, {}, 5), Indices{});
}

TEST(PairAtNearestStamps, GivesAPoseToAllThatAreNearestToIt) {
  EXPECT_EQ(Paired({0, 100, 200}, {97, 102}, 20), (Indices{{1, 0}, {1, 1}}));
  EXPECT_EQ(Paired({0, 100, 200, 300}, {95, 99, 104}, 20), (Indices{{1, 0}, {1, 1}, {1, 2}}));
}

// By hand after numpy's searchsorted(side="right"), which evo 1.38 calls.
TEST(PairAtNearestStamps, TakesOfEqualStampsTheOneThatEvoTakes) {
  EXPECT_EQ(Paired({0, 10, 10, 20, 30}, {9, 10, 11}, 5), (Indices{{1, 0}, {2, 1}, {2, 2}}));
  EXPECT_EQ(Paired({10, 10, 10, 10}, {8, 10, 12}, 5), (Indices{{0, 0}, {2, 1}, {3, 2}}));  // evo's rule at the end
  EXPECT_EQ(Paired({0, 10, 20, 30}, {10, 10, 12}, 5), (Indices{{1, 0}, {1, 1}, {1, 2}}));
  EXPECT_EQ(Paired({1000, 1000}, {0, 875, 1125, 2000}, 500), (Indices{{0, 1}, {1, 1}}));
}

}  // namespace
}  // namespace merlin
