#include "perception/filter/unwrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "perception/project.h"
#include "tests/support/pmd_3k.h"

namespace merlin {
namespace {

constexpr double kFrequency_hz = 30e6;
const double kU_m = kSpeedOfLight_m_s / (2.0 * kFrequency_hz);  // 4.997 m

// Where a ray ends, and how bright that is: albedo times the cosine of incidence.
struct Hit {
  double range_m = HUGE_VAL, brightness = 0.0;
};
using World = std::function<Hit(const Eigen::Vector3d& ray)>;  // ray: unit, optical frame

// A plane with this unit normal (towards the camera), at this distance from it.
Hit Plane(const Eigen::Vector3d& ray, const Eigen::Vector3d& normal, double distance_m, double albedo) {
  const double cosine = -normal.dot(ray);
  return cosine > 1e-3 ? Hit{distance_m / cosine, albedo * cosine} : Hit{};
}

Hit Nearer(const Hit& a, const Hit& b) { return a.range_m < b.range_m ? a : b; }

struct Seen {
  DepthFrame frame;             // wrapped, as a camera gives it
  std::vector<double> truth_m;  // not wrapped
};

Seen Look(const World& world) {
  const DepthCameraSheet sheet = Pmd3k();
  Seen seen;
  seen.frame.settings.frequency_hz = kFrequency_hz;
  seen.frame.width = sheet.camera.width;
  seen.frame.height = sheet.camera.height;
  const double lamp_e_m2 = sheet.LampAmplitude_e_m2(seen.frame.settings);
  for (const Eigen::Vector3f& ray : PixelRays(sheet.camera)) {
    const Hit hit = world(ray.cast<double>());
    seen.truth_m.push_back(hit.range_m);
    seen.frame.range_m.push_back(static_cast<float>(std::fmod(hit.range_m, kU_m)));
    seen.frame.amplitude.push_back(static_cast<float>(lamp_e_m2 * hit.brightness / (hit.range_m * hit.range_m)));
  }
  seen.frame.flags.assign(seen.frame.size(), 0);
  seen.frame.intensity.assign(seen.frame.size(), 0);
  return seen;
}

// Pixels that are accepted at their true range (within 2 %), and pixels accepted at a wrong one.
struct Score {
  int right = 0, wrong = 0;
};

Score ScoreOf(const Seen& seen) {
  const FilteredDepth filtered = FilterDepth(seen.frame, Pmd3k(), {});
  Score score;
  for (std::size_t i = 0; i < seen.truth_m.size(); ++i) {
    if (filtered.reasons[i] != Rejection::kNone) continue;
    // The median takes the value of a neighbour; on the most oblique surface here that is the agreement tolerance away.
    const bool right = std::abs(filtered.frame.range_m[i] - seen.truth_m[i]) <= 0.12 * seen.truth_m[i];
    ++(right ? score.right : score.wrong);
  }
  return score;
}

// Left wall of albedo 0.7 at 0.9 m, with an end wall of albedo 0.7 far beyond the wrap.
World Corridor(double end_m) {
  return [end_m](const Eigen::Vector3d& ray) {
    return Nearer(Plane(ray, Eigen::Vector3d::UnitX(), 0.9, 0.7), Plane(ray, -Eigen::Vector3d::UnitZ(), end_m, 0.7));
  };
}

TEST(Unwrap, FollowsAWallFromItsNearEndBeyondTheWrap) {
  const Seen seen = Look(Corridor(9.0));
  const Score score = ScoreOf(seen);
  const auto beyond = [](double range_m) { return range_m > kU_m + 0.3 && range_m < 8.0; };
  EXPECT_EQ(score.wrong, 0);
  EXPECT_GT(score.right,
            0.6 * static_cast<double>(std::ranges::count_if(seen.truth_m, [](double m) { return m < 8.0; })));
  EXPECT_GT(std::ranges::count_if(seen.truth_m, beyond), 100);
}

TEST(Unwrap, AcceptsNothingOfAFacingWallBeyondTheWrap) {
  for (const double distance_m : {5.1, 6.0, 7.0, 8.0, 9.5, 11.0, 14.0}) {
    const Seen seen =
        Look([=](const Eigen::Vector3d& ray) { return Plane(ray, -Eigen::Vector3d::UnitZ(), distance_m, 0.8); });
    EXPECT_EQ(ScoreOf(seen).wrong, 0) << distance_m;
  }
}

// A person, 0.4 m wide, at the range that the wall behind seems to have.
TEST(Unwrap, DoesNotSpreadFromANearObjectToTheGhostBehindIt) {
  for (const double person_m : {0.8, 1.5, 2.0, 2.5}) {
    const Seen seen = Look([=](const Eigen::Vector3d& ray) {
      const Hit wall = Plane(ray, -Eigen::Vector3d::UnitZ(), person_m + kU_m, 0.8);
      const Hit person = Plane(ray, -Eigen::Vector3d::UnitZ(), person_m, 0.4);
      return std::abs(ray.x() / ray.z() * person_m) < 0.2 ? person : wall;
    });
    const Score score = ScoreOf(seen);
    EXPECT_EQ(score.wrong, 0) << person_m;
    const auto near = std::ranges::count_if(seen.truth_m, [&](double m) { return m < 1.2 * person_m; });
    EXPECT_GE(score.right, 0.95 * static_cast<double>(near)) << person_m;
  }
}

TEST(Unwrap, LeavesAFrameAloneInWhichEnoughIsKnown) {
  // The same wall to the left, and a bright facing one that fills more than a quarter of the picture.
  const Seen seen = Look([](const Eigen::Vector3d& ray) {
    return Nearer(Corridor(9.0)(ray), ray.x() > 0.05 ? Plane(ray, -Eigen::Vector3d::UnitZ(), 1.5, 0.7) : Hit{});
  });
  EXPECT_EQ(ScoreOf(seen).wrong, 0);
  const FilteredDepth filtered = FilterDepth(seen.frame, Pmd3k(), {});
  for (std::size_t i = 0; i < seen.truth_m.size(); ++i)
    if (filtered.reasons[i] == Rejection::kNone) {
      EXPECT_LT(filtered.frame.range_m[i], kU_m);
    }
}

TEST(Unwrap, TakesFramesWithoutLightOrPixels) {
  Seen dark = Look(Corridor(9.0));
  std::ranges::fill(dark.frame.amplitude, std::nanf(""));
  EXPECT_EQ(ScoreOf(dark).right + ScoreOf(dark).wrong, 0);
  std::ranges::fill(dark.frame.amplitude, 0.0f);
  EXPECT_EQ(ScoreOf(dark).right + ScoreOf(dark).wrong, 0);
  EXPECT_TRUE(FilterDepth(DepthFrame{}, Pmd3k(), {}).reasons.empty());
}

}  // namespace
}  // namespace merlin
