#include "perception/angle_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace merlin {
namespace {

PanState At(double t_s, double angle_rad) { return {FromSeconds(t_s), angle_rad}; }

TEST(AngleTrack, KnowsNothingBeforeTheFirstReading) { EXPECT_FALSE(AngleTrack().At(Time(0))); }

TEST(AngleTrack, GoesStraightBetweenReadingsAndStaysBeyondThem) {
  AngleTrack track;
  track.Add(At(1.0, 0.5));
  EXPECT_DOUBLE_EQ(*track.At(Time(0)), 0.5);
  EXPECT_DOUBLE_EQ(*track.At(FromSeconds(9.0)), 0.5);
  track.Add(At(1.5, -0.5));
  EXPECT_DOUBLE_EQ(*track.At(FromSeconds(1.0)), 0.5);
  EXPECT_NEAR(*track.At(FromSeconds(1.2)), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(*track.At(FromSeconds(1.5)), -0.5);
  EXPECT_DOUBLE_EQ(*track.At(FromSeconds(2.0)), -0.5);
}

// A servo that accelerates evenly from rest at 0.1 s: 50 rad/s2 for 0.02 s.
TEST(AngleTrack, SetsOffSlowlyFromRest) {
  AngleTrack track;
  for (const double t_s : {0.06, 0.08, 0.1}) track.Add(At(t_s, 0.2));
  track.Add(At(0.12, 0.2 + 0.01));
  track.Add(At(0.14, 0.2 + 0.03));
  EXPECT_DOUBLE_EQ(*track.At(FromSeconds(0.09)), 0.2);
  EXPECT_NEAR(*track.At(FromSeconds(0.104)), 0.2 + 0.5 * 50.0 * 0.004 * 0.004, 4e-4);  // a straight line: 16e-4 off
  EXPECT_NEAR(*track.At(FromSeconds(0.12)), 0.21, 1e-12);
}

TEST(AngleTrack, NeverOvershoots) {
  AngleTrack track;
  const std::vector<double> angles{0.0, 0.0, 0.3, 0.31, 0.31, 0.1, 0.4};
  for (std::size_t i = 0; i < angles.size(); ++i) track.Add(At(0.02 * static_cast<double>(i), angles[i]));
  for (std::size_t i = 0; i + 1 < angles.size(); ++i)
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      const double angle_rad = *track.At(FromSeconds(0.02 * (static_cast<double>(i) + share)));
      EXPECT_GE(angle_rad, std::min(angles[i], angles[i + 1]) - 1e-9);
      EXPECT_LE(angle_rad, std::max(angles[i], angles[i + 1]) + 1e-9);
    }
}

TEST(AngleTrack, DoesNotWrapBeyondATurn) {
  AngleTrack track;
  track.Add(At(0.0, 3.1));
  track.Add(At(0.1, 3.3));
  EXPECT_NEAR(*track.At(FromSeconds(0.05)), 3.2, 1e-12);
}

TEST(AngleTrack, LeavesOutWhatIsNotFiniteOrNotNewer) {
  AngleTrack track;
  track.Add(At(1.0, 0.5));
  track.Add(At(1.1, std::nan("")));
  track.Add(At(1.0, 2.0));
  track.Add(At(0.5, 2.0));
  EXPECT_DOUBLE_EQ(*track.At(FromSeconds(2.0)), 0.5);
}

TEST(AngleTrack, KeepsTheLastSecond) {
  AngleTrack track;
  for (int i = 0; i <= 300; ++i) track.Add(At(0.01 * i, 0.01 * i));
  EXPECT_NEAR(*track.At(FromSeconds(2.345)), 2.345, 1e-9);
  EXPECT_NEAR(*track.At(FromSeconds(0.5)), 2.0, 1e-9);
}

}  // namespace
}  // namespace merlin
