#include "perception/angle_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
