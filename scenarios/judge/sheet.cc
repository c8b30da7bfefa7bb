#include "scenarios/judge/sheet.h"

#include <algorithm>

namespace merlin {
namespace {

constexpr double kHeader_px = 112, kFooter_px = 92;
constexpr double kPlotWidth_px = Sheet::kWidth_px - 2.0 * Sheet::kMargin_px;
constexpr double kPlotHeightMin_px = 420, kPlotHeightMax_px = 1300;
constexpr double kPad_m = 0.8;         // free space around the box
constexpr double kSmallestView_m = 4;  // a car that does not move is shown with its surroundings
const cv::Scalar kPlot(247, 248, 248);

Eigen::Vector2d PaddedSize_m(const Box& box) {
  return (box.max - box.min + Eigen::Vector2d::Constant(2.0 * kPad_m)).cwiseMax(kSmallestView_m);
}

double PlotHeight_px(const Eigen::Vector2d& size_m) {
  return std::round(std::clamp(kPlotWidth_px * size_m.y() / size_m.x(), kPlotHeightMin_px, kPlotHeightMax_px));
}

}  // namespace

Sheet::Sheet(const Box& box)
    : plot_height_px_(PlotHeight_px(PaddedSize_m(box))),
      canvas_(static_cast<int>(kWidth_px), static_cast<int>(Height_px())) {
  const Eigen::Vector2d middle = 0.5 * (box.min + box.max), size = PaddedSize_m(box);
  px_per_m_ = std::min(kPlotWidth_px / size.x(), plot_height_px_ / size.y());
  const Eigen::Vector2d half_m = 0.5 / px_per_m_ * Eigen::Vector2d(kPlotWidth_px, plot_height_px_);
  view_ = {middle - half_m, middle + half_m};
  canvas_.Fill({kMargin_px, kHeader_px}, {kWidth_px - kMargin_px, kHeader_px + plot_height_px_}, kPlot);
}

double Sheet::Height_px() const { return kHeader_px + plot_height_px_ + kFooter_px; }

bool Sheet::Shows(const Eigen::Vector2d& p) const {
  return (p.array() >= view_.min.array()).all() && (p.array() <= view_.max.array()).all();
}

Eigen::Vector2d Sheet::Pixel(const Eigen::Vector2d& p) const {
  return {kMargin_px + (p.x() - view_.min.x()) * px_per_m_, kHeader_px + (view_.max.y() - p.y()) * px_per_m_};
}

void Sheet::LineInWorld(const std::vector<Eigen::Vector2d>& points_m, double width_px, const cv::Scalar& color,
                        bool closed) {
  std::vector<Eigen::Vector2d> points_px;
  for (const Eigen::Vector2d& p : points_m) points_px.push_back(Pixel(p));
  canvas_.Line(points_px, width_px, color, closed);
}

}  // namespace merlin
