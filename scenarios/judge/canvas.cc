#include "scenarios/judge/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr int kOversample = 2;  // drawn this many times as large and averaged down
constexpr int kShift = 4;       // fractional bits of OpenCV's drawing coordinates
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

double FontScale(double size_px) { return size_px * kOversample / 21.0; }  // Hershey capitals are 21 units high

cv::Point Fixed(const Eigen::Vector2d& p_px) {
  const Eigen::Vector2d fixed = (p_px * kOversample * (1 << kShift)).cwiseMax(-1e8).cwiseMin(1e8);
  return {static_cast<int>(std::lround(fixed.x())), static_cast<int>(std::lround(fixed.y()))};
}

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : image_(height_px * kOversample, width_px * kOversample, CV_8UC3, cv::Scalar(255, 255, 255)) {}

void Canvas::Fill(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, const cv::Scalar& color) {
  cv::rectangle(image_, Fixed(a_px), Fixed(b_px), color, cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::Line(const std::vector<Eigen::Vector2d>& points_px, double width_px, const cv::Scalar& color,
                  bool closed) {
  std::vector<cv::Point> fixed;
  for (const Eigen::Vector2d& p : points_px) fixed.push_back(Fixed(p));
  const int width = std::max(1, static_cast<int>(std::lround(width_px * kOversample)));
  cv::polylines(image_, fixed, closed, color, width, cv::LINE_AA, kShift);
}

void Canvas::Dot(const Eigen::Vector2d& p_px, double radius_px, const cv::Scalar& color) {
  const int radius = static_cast<int>(std::lround(radius_px * kOversample * (1 << kShift)));
  cv::circle(image_, Fixed(p_px), radius, color, cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::Speck(const Eigen::Vector2d& p_px, double edge_px, const cv::Scalar& color) {
  const int edge = std::max(1, static_cast<int>(std::lround(edge_px * kOversample)));
  const Eigen::Vector2d corner_px = p_px * kOversample - Eigen::Vector2d::Constant(edge / 2);
  const cv::Point corner(static_cast<int>(std::lround(corner_px.x())), static_cast<int>(std::lround(corner_px.y())));
  image_(cv::Rect(corner, cv::Size(edge, edge)) & cv::Rect({}, image_.size())).setTo(color);
}

void Canvas::Text(const Eigen::Vector2d& p_px, const std::string& text, double size_px, const cv::Scalar& color,
                  TextAlign align, bool bold) {
  const int width = (bold ? 2 : 1) * kOversample;
  int base_line = 0;
  const cv::Size size = cv::getTextSize(text, kFont, FontScale(size_px), width, &base_line);
  const double share = align == TextAlign::kLeft ? 0.0 : align == TextAlign::kMiddle ? 0.5 : 1.0;
  const cv::Point start(static_cast<int>(std::lround(p_px.x() * kOversample - share * size.width)),
                        static_cast<int>(std::lround(p_px.y() * kOversample)));
  cv::putText(image_, text, start, kFont, FontScale(size_px), color, width, cv::LINE_AA);
}

double Canvas::TextWidth_px(const std::string& text, double size_px) {
  int base_line = 0;
  const cv::Size size = cv::getTextSize(text, kFont, FontScale(size_px), kOversample, &base_line);
  return size.width / static_cast<double>(kOversample);
}

void Canvas::Picture(const Eigen::Vector2d& corner_px, const cv::Mat& bgr, int scale) {
  const cv::Size size = bgr.size() * scale * kOversample;
  const cv::Point corner(static_cast<int>(corner_px.x()) * kOversample, static_cast<int>(corner_px.y()) * kOversample);
  cv::resize(bgr, image_(cv::Rect(corner, size)), size, 0.0, 0.0, cv::INTER_NEAREST);
}

std::string Canvas::ToPng() const {
  cv::Mat picture;
  cv::resize(image_, picture, cv::Size(), 1.0 / kOversample, 1.0 / kOversample, cv::INTER_AREA);
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", picture, bytes)) throw MachineError("OpenCV has no PNG encoder");
  return {bytes.begin(), bytes.end()};
}

}  // namespace merlin
