#include "scenarios/judge/sheet.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace merlin {
namespace {

constexpr int kOversample = 2;  // drawn this many times as large and averaged down
constexpr int kShift = 4;       // fractional bits of OpenCV's drawing coordinates
constexpr double kHeader_px = 112, kFooter_px = 92;
constexpr double kPlotHeightMin_px = 420, kPlotHeightMax_px = 1300;
constexpr double kPad_m = 0.8;         // free space around the box
constexpr double kSmallestView_m = 4;  // a car that stands is shown with its surroundings
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Scalar kPaper(255, 255, 255), kPlot(247, 248, 248);

double FontScale(double size_px) { return size_px * kOversample / 21.0; }  // Hershey capitals are 21 units high

cv::Point Fixed(const Eigen::Vector2d& p_px) {
  const Eigen::Vector2d fixed = (p_px * kOversample * (1 << kShift)).cwiseMax(-1e8).cwiseMin(1e8);
  return {static_cast<int>(std::lround(fixed.x())), static_cast<int>(std::lround(fixed.y()))};
}

}  // namespace

Sheet::Sheet(const Box& box) {
  const Eigen::Vector2d middle = 0.5 * (box.min + box.max);
  const Eigen::Vector2d size = (box.max - box.min + Eigen::Vector2d::Constant(2.0 * kPad_m)).cwiseMax(kSmallestView_m);
  const double plot_width_px = kWidth_px - 2.0 * kMargin_px;
  plot_height_px_ = std::round(std::clamp(plot_width_px * size.y() / size.x(), kPlotHeightMin_px, kPlotHeightMax_px));
  px_per_m_ = std::min(plot_width_px / size.x(), plot_height_px_ / size.y());
  const Eigen::Vector2d half_m = 0.5 / px_per_m_ * Eigen::Vector2d(plot_width_px, plot_height_px_);
  view_ = {middle - half_m, middle + half_m};
  image_ =
      cv::Mat(static_cast<int>(Height_px()) * kOversample, static_cast<int>(kWidth_px) * kOversample, CV_8UC3, kPaper);
  Fill({kMargin_px, kHeader_px}, {kWidth_px - kMargin_px, kHeader_px + plot_height_px_}, kPlot);
}

double Sheet::Height_px() const { return kHeader_px + plot_height_px_ + kFooter_px; }

bool Sheet::Shows(const Eigen::Vector2d& p) const {
  return (p.array() >= view_.min.array()).all() && (p.array() <= view_.max.array()).all();
}

Eigen::Vector2d Sheet::Pixel(const Eigen::Vector2d& p) const {
  return {kMargin_px + (p.x() - view_.min.x()) * px_per_m_, kHeader_px + (view_.max.y() - p.y()) * px_per_m_};
}

void Sheet::Fill(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, const cv::Scalar& color) {
  cv::rectangle(image_, Fixed(a_px), Fixed(b_px), color, cv::FILLED, cv::LINE_AA, kShift);
}

void Sheet::Line(const std::vector<Eigen::Vector2d>& points_px, double width_px, const cv::Scalar& color, bool closed) {
  std::vector<cv::Point> fixed;
  for (const Eigen::Vector2d& p : points_px) fixed.push_back(Fixed(p));
  const int width = std::max(1, static_cast<int>(std::lround(width_px * kOversample)));
  cv::polylines(image_, fixed, closed, color, width, cv::LINE_AA, kShift);
}

void Sheet::LineInWorld(const std::vector<Eigen::Vector2d>& points_m, double width_px, const cv::Scalar& color,
                        bool closed) {
  std::vector<Eigen::Vector2d> points_px;
  for (const Eigen::Vector2d& p : points_m) points_px.push_back(Pixel(p));
  Line(points_px, width_px, color, closed);
}

void Sheet::Dot(const Eigen::Vector2d& p_px, double radius_px, const cv::Scalar& color) {
  cv::circle(image_, Fixed(p_px), static_cast<int>(std::lround(radius_px * kOversample * (1 << kShift))), color,
             cv::FILLED, cv::LINE_AA, kShift);
}

void Sheet::Speck(const Eigen::Vector2d& p_px, double edge_px, const cv::Scalar& color) {
  const int edge = std::max(1, static_cast<int>(std::lround(edge_px * kOversample)));
  const Eigen::Vector2d corner_px = p_px * kOversample - Eigen::Vector2d::Constant(edge / 2);
  const cv::Point corner(static_cast<int>(std::lround(corner_px.x())), static_cast<int>(std::lround(corner_px.y())));
  image_(cv::Rect(corner, cv::Size(edge, edge)) & cv::Rect({}, image_.size())).setTo(color);
}

void Sheet::Text(const Eigen::Vector2d& p_px, const std::string& text, double size_px, const cv::Scalar& color,
                 bool bold) {
  const Eigen::Vector2d start = p_px * kOversample;
  cv::putText(image_, text, cv::Point(static_cast<int>(start.x()), static_cast<int>(start.y())), kFont,
              FontScale(size_px), color, (bold ? 2 : 1) * kOversample, cv::LINE_AA);
}

double Sheet::TextWidth_px(const std::string& text, double size_px) const {
  int base_line = 0;
  const cv::Size size = cv::getTextSize(text, kFont, FontScale(size_px), kOversample, &base_line);
  return size.width / static_cast<double>(kOversample);
}

cv::Mat Sheet::Finished() const {
  cv::Mat picture;
  cv::resize(image_, picture, cv::Size(), 1.0 / kOversample, 1.0 / kOversample, cv::INTER_AREA);
  return picture;
}

}  // namespace merlin
