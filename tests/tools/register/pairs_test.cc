#include "tools/register/pairs.h"

#include <gtest/gtest.h>

#include "slam/register/align.h"
#include "slam/register/neighbours.h"

namespace merlin {
namespace {

// Scene and noise are random: where each true ground point lies is not.
TEST(SimulatedPair, HasSeventyThousandPointsOnTheSameGroundOfSeventyMetres) {
  const RegisterPair pair = SimulatedPair();
  EXPECT_EQ(pair.source.size(), 70'000u);
  EXPECT_EQ(pair.target.size(), 70'000u);
  EXPECT_GT(Diagonal_m(pair.target), 60.0);
  EXPECT_LT(Diagonal_m(pair.target), 110.0);
  EXPECT_EQ(SimulatedPair().source.positions, pair.source.positions);
  EXPECT_EQ(SimulatedPair().target.positions, pair.target.positions);
  // In the target's frame the ground is 1.8 m below the lidar; nothing is below it but noise.
  for (const Eigen::Vector3d& position : pair.source.positions)
    EXPECT_GT((pair.T_target_source * position).z(), -1.8 - 0.1);
  // Most of what both see is the same surface: within half a metre, the distance of two beams on the ground.
  const Neighbours tree(pair.target.positions);
  int near = 0;
  for (const Eigen::Vector3d& position : pair.source.positions)
    near += tree.Nearest(pair.T_target_source * position, 0.5) ? 1 : 0;
  EXPECT_GT(near, 60'000);
}

TEST(SimulatedPair, IsAlignedToAMillimetreAtEqualVoxelsAndAtTheChosenOne) {
  const RegisterPair pair = SimulatedPair();
  const ThinPair fit = ThinToFit(pair.source, pair.target);
  EXPECT_LE(std::max(fit.source.size(), fit.target.size()), 20'000u);
  const ThinPair quarter{Thin(pair.source, 0.25), Thin(pair.target, 0.25), 0.25};
  for (const ThinPair* thin : {&fit, &quarter}) {
    const AlignResult result = Align(thin->source, thin->target, pair.guess, {});
    EXPECT_TRUE(result.converged());
    const Pose error = pair.T_target_source.inverse() * result.T_target_source;
    EXPECT_LT(error.translation().norm(), 0.001);
    EXPECT_LT(LogSo3(error.linear()).norm(), 1e-4);
  }
}

TEST(RgbdPairs, AreNoneWithoutTheFolder) { EXPECT_TRUE(RgbdPairs("no/such/folder").empty()); }

}  // namespace
}  // namespace merlin
