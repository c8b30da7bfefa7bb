#include "slam/map/clear_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace merlin {
namespace {

// A grid of pixels around straight ahead, 0.05 apart, with rays of length length_m(across, up).
template <class Length>
Observation Seen(Length length_m) {
  Observation seen;
  for (int across = -10; across <= 10; ++across)
    for (int up = -10; up <= 10; ++up) {
      const Eigen::Vector3f ray = Eigen::Vector3f(1.0f, 0.05f * across, 0.05f * up).normalized();
      seen.points_base.push_back({.position = ray * static_cast<float>(length_m(across, up))});
    }
  return seen;
}

TEST(ClearView, GivesTheShortestRayAround) {
  const ClearView view(Seen([](int across, int up) { return across == 4 && up == -3 ? 1.0 : 2.0 + 0.01 * across; }));
  EXPECT_NEAR(view.Along({1.0f, -0.125f, 0.225f}).length_m, 2.0 - 0.03, 0.005);  // between -3 and -2: the nearer
  EXPECT_NEAR(view.Along({2.0f, 0.45f, -0.35f}).length_m, 1.0, 0.005);           // beside the short one
  EXPECT_NEAR(view.Along({2.0f, 0.75f, -0.35f}).length_m, 2.07, 0.01);           // two pixels on
  EXPECT_EQ(view.Along({1.0f, 0.7f, 0.0f}).length_m, 0.0f);                      // beside the view
  EXPECT_EQ(view.Along({-1.0f, 0.0f, 0.0f}).length_m, 0.0f);                     // behind the camera
  EXPECT_EQ(view.Along({std::nanf(""), 0.0f, 0.0f}).length_m, 0.0f);
  EXPECT_FALSE(view.Along({1.0f, 0.0f, 0.0f}).dark);
  EXPECT_NEAR(view.reach_m(), 2.1f, 1e-5f);
}

TEST(ClearView, LooksLevelThatWayInWhichItsRaysDo) {
  Observation seen = Seen([](int, int up) { return up > 0 ? 2.0 : 3.0; });
  std::erase_if(seen.points_base,
                [](const Point& point) { return point.position.z() < -0.3f * point.position.x(); });  // looks up
  const Pose T = FromXyYaw(1.0, 2.0, 2.5);
  for (Point& point : seen.points_base) point.position = (T * point.position.cast<double>()).cast<float>();
  seen.camera_base = T.translation().cast<float>();
  const ClearView view(seen);
  EXPECT_TRUE(view.R_view_base().isApprox(T.linear().transpose().cast<float>(), 1e-5f));
  EXPECT_NEAR(view.Along({1.0f, 0.0f, 0.225f}).length_m, 2.0, 0.005);
  EXPECT_NEAR(view.Along({1.0f, 0.0f, -0.225f}).length_m, 3.0, 0.005);
}

TEST(ClearView, TellsDarkRaysAndIsSilentBesideUnknownOnes) {
  Observation seen = Seen([](int across, int) { return across == 0 ? 2.5 : 3.0; });
  const auto take = [&seen](float across, float up) {
    const auto at = std::ranges::find_if(seen.points_base, [&](const Point& point) {
      return std::abs(point.position.y() / point.position.x() - across) < 0.01f &&
             std::abs(point.position.z() / point.position.x() - up) < 0.01f;
    });
    const Eigen::Vector3f end = at->position;
    seen.points_base.erase(at);
    return end;
  };
  seen.free_base.push_back(take(0.25f, 0.25f));
  seen.unknown_base.push_back(take(-0.25f, 0.25f).normalized());
  seen.saturated_base.push_back(take(0.25f, -0.25f).normalized());
  const ClearView view(seen);
  for (const float side : {-0.02f, 0.02f}) {
    EXPECT_TRUE(view.Along({1.0f, 0.25f + side, 0.25f - side}).dark);
    EXPECT_NEAR(view.Along({1.0f, 0.25f + side, 0.25f - side}).length_m, 3.0, 0.005);
    EXPECT_EQ(view.Along({1.0f, -0.25f + side, 0.25f + side}).length_m, 0.0f);
    EXPECT_EQ(view.Along({1.0f, 0.25f - side, -0.25f + side}).length_m, 0.0f);
  }
  EXPECT_FALSE(view.Along({1.0f, 0.1f, 0.1f}).dark);
}

TEST(ClearView, IsUnknownWithoutRays) {
  const auto ends = [](std::vector<Eigen::Vector3f> points) {
    Observation seen;
    for (const Eigen::Vector3f& point : points) seen.points_base.push_back({.position = point});
    return seen;
  };
  Observation around;  // all directions: no middle
  for (int i = 0; i < 360; ++i)
    around.points_base.push_back(
        {.position = {2.0f * std::cos(0.0174533f * i), 2.0f * std::sin(0.0174533f * i), 0.0f}});
  for (const Observation& seen :
       {Observation{}, ends({{std::nanf(""), 0.0f, 0.0f}, {HUGE_VALF, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}}),
        ends({{0.0f, 0.0f, 2.0f}}), around}) {
    const ClearView view(seen);
    EXPECT_EQ(view.Along({1.0f, 0.0f, 0.0f}).length_m, 0.0f);
    EXPECT_EQ(view.Along({0.0f, 0.0f, 0.0f}).length_m, 0.0f);
  }
  EXPECT_EQ(ClearView().Along({1.0f, 0.0f, 0.0f}).length_m, 0.0f);
  EXPECT_NEAR(ClearView(ends({{2.0f, 0.0f, 0.0f}})).Along({1.0f, 0.0f, 0.0f}).length_m, 2.0, 0.005);  // one ray alone
}

}  // namespace
}  // namespace merlin
