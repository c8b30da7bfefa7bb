#include "scenarios/judge/map_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/scenarios/judge/synthetic_room.h"

namespace merlin {
namespace {

cv::Mat Drawn(const MapPicture& picture) {
  const std::string png = ToPng(picture);
  return cv::imdecode(std::vector<std::uint8_t>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

// Pixels of about this colour (blue, green, red).
int Count(const cv::Mat& image, const cv::Scalar& color) {
  cv::Mat mask;
  cv::inRange(image, color - cv::Scalar::all(6), color + cv::Scalar::all(6), mask);
  return cv::countNonZero(mask);
}

const cv::Scalar kTruth(60, 160, 250), kEstimate(35, 20, 190);

Trajectory Straight(double y_m) {
  Trajectory path;
  for (int i = 0; i <= 40; ++i) path.push_back({Time(i), FromXyYaw(-2.0 + 0.1 * i, y_m, 0)});
  return path;
}

TEST(MapPicture, ShowsBothPathsAndTheMap) {
  const std::vector<MapPoint> map = CloudOfWalls(Rectangle(6, 4));
  MapPicture picture{.title = "room, seed 1", .map = map, .outline = Rectangle(6, 4), .truth = Straight(0.5)};
  const cv::Mat truth_only = Drawn(picture);
  EXPECT_EQ(truth_only.cols, 1400);
  const double px_per_m = 1304.0 / 7.6;                      // 6 m and 0.8 m on either side
  EXPECT_GT(Count(truth_only, kTruth), 3.7 * px_per_m * 4);  // 6 px wide, edges blended
  picture.estimate = Straight(-0.5);
  const cv::Mat both = Drawn(picture);
  EXPECT_EQ(both.size(), truth_only.size());
  EXPECT_GT(Count(both, kEstimate), Count(truth_only, kEstimate) + 3.7 * px_per_m);
  // The plan's upper left corner, and a wall's points beside its line.
  const cv::Point corner(static_cast<int>(48 + 0.8 * px_per_m), static_cast<int>(112 + 0.8 * px_per_m));
  const cv::Mat around = truth_only(cv::Rect(corner - cv::Point(3, 3), cv::Size(7, 7)));
  double darkest = 0.0;
  cv::minMaxLoc(around.reshape(1), &darkest);
  EXPECT_LT(darkest, 60.0);
}

TEST(MapPicture, DrawsTheEstimateAfterItsAlignment) {
  MapPicture picture{.title = "t", .outline = Rectangle(6, 4), .truth = Straight(0), .estimate = Straight(0)};
  const std::string expected = ToPng(picture);
  const Pose T_world_map = FromXyYaw(1, 2, 0.5);
  for (StampedPose& pose : picture.estimate) pose.T = T_world_map.inverse() * pose.T;
  EXPECT_NE(ToPng(picture), expected);
  picture.T_world_map = T_world_map;
  EXPECT_LT(cv::norm(Drawn(picture), cv::imdecode(std::vector<std::uint8_t>(expected.begin(), expected.end()), 1),
                     cv::NORM_INF),
            16.0);  // coordinates rounded the other way here and there
}

TEST(MapPicture, IsTheSameForTheSameInput) {
  const std::vector<MapPoint> map = CloudOfWalls(Rectangle(6, 4));
  const MapPicture picture{.title = "t", .map = map, .outline = Rectangle(6, 4), .truth = Straight(0)};
  EXPECT_EQ(ToPng(picture), ToPng(picture));
}

TEST(MapPicture, ManagesWithLittleOrNothing) {
  const std::vector<MapPoint> map = CloudOfWalls(Rectangle(6, 4));
  const std::vector<MapPoint> one{{{1, 2, 3}}};
  EXPECT_EQ(Drawn({.title = ""}).cols, 1400);
  EXPECT_EQ(Drawn({.title = "no plan", .map = map, .truth = Straight(0)}).cols, 1400);
  EXPECT_EQ(Drawn({.title = "one point", .map = one}).cols, 1400);
  EXPECT_EQ(Drawn({.title = "one pose", .truth = {{Time(0), FromXyYaw(3, 4, 5)}}}).cols, 1400);
  EXPECT_EQ(Drawn({.title = "long and thin", .outline = Rectangle(100, 1)}).cols, 1400);
  EXPECT_EQ(Drawn({.title = "high", .outline = Rectangle(1, 100)}).cols, 1400);
}

TEST(MapPicture, LeavesOutWhatIsNotFinite) {
  std::vector<MapPoint> map = CloudOfWalls(Rectangle(6, 4));
  MapPicture picture{.title = "t", .map = map, .outline = Rectangle(6, 4), .truth = Straight(0)};
  const std::string expected = ToPng(picture);
  map.push_back({Eigen::Vector3f::Constant(std::nanf(""))});
  map.push_back({{1e30f, 0, 0}});
  picture.map = map;
  picture.truth.push_back({Time(99), FromXyYaw(std::nan(""), 0, 0)});
  EXPECT_EQ(ToPng(picture), expected);
}

}  // namespace
}  // namespace merlin
