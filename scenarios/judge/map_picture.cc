#include "scenarios/judge/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "scenarios/judge/point_grid.h"
#include "scenarios/judge/sheet.h"

namespace merlin {
namespace {

constexpr double kCeiling_m = 2.5;
constexpr double kFloor_m = 0.1;  // lower points are drawn pale, so that walls stand out

// Blue, green, red.
const cv::Scalar kPaper(255, 255, 255), kGrid(230, 232, 232), kPale(120, 115, 110), kFloorColor(214, 220, 208);
const cv::Scalar kPlanColor(0, 0, 0), kTruthColor(60, 160, 250), kEstimateColor(35, 20, 190);

// Floor pale, then low: green, high: dark blue (a part of viridis).
cv::Scalar HeightColor(const cv::Mat& ramp, double height_m) {
  if (height_m < kFloor_m) return kFloorColor;
  const double share = std::clamp(height_m / kCeiling_m, 0.0, 1.0);
  const auto color = ramp.at<cv::Vec3b>(static_cast<int>(std::lround(170.0 - 140.0 * share)), 0);
  return cv::Scalar(color[0], color[1], color[2]);
}

cv::Mat HeightRamp() {
  cv::Mat grey(256, 1, CV_8UC1), ramp;
  for (int i = 0; i < 256; ++i) grey.at<std::uint8_t>(i, 0) = static_cast<std::uint8_t>(i);
  cv::applyColorMap(grey, ramp, cv::COLORMAP_VIRIDIS);
  return ramp;
}

std::vector<Eigen::Vector2d> Positions(const Trajectory& trajectory, const Pose& T_world_frame) {
  std::vector<Eigen::Vector2d> positions;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector2d p = (T_world_frame * pose.T.translation()).head<2>();
    if (p.allFinite()) positions.push_back(p);
  }
  return positions;
}

// The box around the cloud without the outermost 1 % on each side, so that a stray point does not shrink the picture.
void AddBulk(Box& box, const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) return;
  const std::ptrdiff_t stray = std::ssize(points) / 100, last = std::ssize(points) - 1;
  Eigen::Vector2d low, high;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points) values.push_back(p[axis]);
    std::nth_element(values.begin(), values.begin() + stray, values.end());
    low[axis] = values[static_cast<std::size_t>(stray)];
    std::nth_element(values.begin(), values.begin() + last - stray, values.end());
    high[axis] = values[static_cast<std::size_t>(last - stray)];
  }
  box.Add(low);
  box.Add(high);
}

// The largest number of the form 1, 2 or 5 times a power of ten that does not exceed the length.
double RoundLength_m(double length_m) {
  const double power = std::pow(10.0, std::floor(std::log10(length_m)));
  const double digit = length_m / power;
  return power * (digit >= 5.0 ? 5.0 : digit >= 2.0 ? 2.0 : 1.0);
}

void DrawGrid(Sheet& sheet, double step_m) {
  const Box& view = sheet.view();
  for (double x = std::ceil(view.min.x() / step_m) * step_m; x <= view.max.x(); x += step_m)
    sheet.LineInWorld({{x, view.min.y()}, {x, view.max.y()}}, 1, kGrid);
  for (double y = std::ceil(view.min.y() / step_m) * step_m; y <= view.max.y(); y += step_m)
    sheet.LineInWorld({{view.min.x(), y}, {view.max.x(), y}}, 1, kGrid);
}

void DrawCloud(Sheet& sheet, std::vector<Eigen::Vector3d> points, const cv::Mat& ramp) {
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  for (const Eigen::Vector3d& p : points)
    if (sheet.Shows(p.head<2>()))
      sheet.canvas().Speck(sheet.Pixel(p.head<2>()), p.z() < kFloor_m ? 1.5 : 3.0, HeightColor(ramp, p.z()));
}

void DrawStart(Sheet& sheet, const Trajectory& truth) {
  if (truth.empty() || !truth.front().T.matrix().allFinite()) return;
  const Eigen::Vector2d start = sheet.Pixel(truth.front().T.translation().head<2>());
  const double yaw_rad = Yaw(truth.front().T);
  const Eigen::Vector2d ahead(std::cos(yaw_rad), -std::sin(yaw_rad)), left(ahead.y(), -ahead.x());
  const Eigen::Vector2d tip = start + 30.0 * ahead;
  sheet.canvas().Line({start, tip}, 3, kInk);
  sheet.canvas().Line({tip - 9.0 * ahead + 7.0 * left, tip, tip - 9.0 * ahead - 7.0 * left}, 3, kInk);
  sheet.canvas().Dot(start, 8.5, kInk);
  sheet.canvas().Dot(start, 5.5, kPaper);
  sheet.canvas().Text(start + Eigen::Vector2d(-18, -16), "start", 12, kInk);
}

std::string Metres(const std::optional<double>& length_m) { return length_m ? fmt::format("{:.2f}", *length_m) : "?"; }

std::string Subtitle(const MapPicture& picture) {
  const MapSize& size = picture.size;
  std::string text = "map's size not known";
  if (size.size_m[0] || size.size_m[1])
    text = fmt::format("map {} x {} m", Metres(size.size_m[0]), Metres(size.size_m[1]));
  if (size.plan_m[0] && size.plan_m[1])
    text += fmt::format(", plan {} x {} m", Metres(size.plan_m[0]), Metres(size.plan_m[1]));
  if (size.error_percent[0] && size.error_percent[1])
    text += fmt::format(" (off by {:.2f} % and {:.2f} %)", *size.error_percent[0], *size.error_percent[1]);
  return picture.ate_rmse_m ? text + fmt::format(", ATE {:.3f} m", *picture.ate_rmse_m) : text + ", ATE not known";
}

void DrawScaleBar(Sheet& sheet, double length_m) {
  const Eigen::Vector2d left(Sheet::kMargin_px, sheet.Height_px() - 38),
      right = left + Eigen::Vector2d(sheet.Metres_px(length_m), 0);
  const Eigen::Vector2d tick(0, 7);
  sheet.canvas().Line({left - tick, left + tick}, 2.5, kInk);
  sheet.canvas().Line({right - tick, right + tick}, 2.5, kInk);
  sheet.canvas().Line({left, right}, 2.5, kInk);
  const std::string label = fmt::format("{} m", length_m);
  sheet.canvas().Text(0.5 * (left + right) + Eigen::Vector2d(-0.5 * Canvas::TextWidth_px(label, 13), -12), label, 13,
                      kInk);
}

// Legend, from the right: the two paths, the plan, the colours of heights.
void DrawLegend(Sheet& sheet, bool has_outline, const cv::Mat& ramp) {
  const double y_px = sheet.Height_px() - 38;
  double x_px = Sheet::kWidth_px - Sheet::kMargin_px;
  const auto entry = [&](const std::string& label, double width_px, const cv::Scalar& color) {
    x_px -= Canvas::TextWidth_px(label, 13);
    sheet.canvas().Text({x_px, y_px + 5}, label, 13, kInk);
    sheet.canvas().Line({{x_px - 48, y_px}, {x_px - 12, y_px}}, width_px, color);
    x_px -= 80;
  };
  entry("estimated path", 2, kEstimateColor);
  entry("true path", 6, kTruthColor);
  if (has_outline) entry("true plan", 1, kPlanColor);
  const std::string high = fmt::format("{} m high", kCeiling_m), low = "map: 0";
  x_px -= Canvas::TextWidth_px(high, 13);
  sheet.canvas().Text({x_px, y_px + 5}, high, 13, kInk);
  x_px -= 12;
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i)
    sheet.canvas().Fill({x_px - kSteps + i, y_px - 6}, {x_px - kSteps + i + 1, y_px + 6},
                        HeightColor(ramp, kCeiling_m * i / kSteps));
  x_px -= kSteps + 10 + Canvas::TextWidth_px(low, 13);
  sheet.canvas().Text({x_px, y_px + 5}, low, 13, kInk);
}

Box View(const MapPicture& picture, const std::vector<Eigen::Vector3d>& points) {
  Box box;
  for (const Eigen::Vector2d& corner : picture.outline) box.Add(corner);
  for (const Eigen::Vector2d& p : Positions(picture.truth, Pose::Identity())) box.Add(p);
  for (const Eigen::Vector2d& p : Positions(picture.estimate, picture.T_world_map)) box.Add(p);
  if (picture.outline.empty()) AddBulk(box, points);
  if (!(box.min.array() <= box.max.array()).all()) box.Add({0.0, 0.0});
  return box;
}

}  // namespace

std::string ToPng(const MapPicture& picture) {
  const std::vector<Eigen::Vector3d> points = ToWorld(picture.map, picture.T_world_map);
  const cv::Mat ramp = HeightRamp();
  Sheet sheet(View(picture, points));
  const double step_m = RoundLength_m(0.3 * (sheet.view().max.x() - sheet.view().min.x()));
  DrawGrid(sheet, step_m);
  DrawCloud(sheet, points, ramp);
  sheet.LineInWorld(picture.outline, 1, kPlanColor, true);
  sheet.LineInWorld(Positions(picture.truth, Pose::Identity()), 6, kTruthColor);
  sheet.LineInWorld(Positions(picture.estimate, picture.T_world_map), 2, kEstimateColor);
  DrawStart(sheet, picture.truth);
  sheet.canvas().Text({Sheet::kMargin_px, 54}, picture.title, 24, kInk, TextAlign::kLeft, true);
  sheet.canvas().Text({Sheet::kMargin_px, 90}, Subtitle(picture), 15, kPale);
  DrawScaleBar(sheet, step_m);
  DrawLegend(sheet, !picture.outline.empty(), ramp);
  return sheet.canvas().ToPng();
}

}  // namespace merlin
