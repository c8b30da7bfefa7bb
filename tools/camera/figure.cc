#include "tools/camera/figure.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scenarios/judge/canvas.h"

namespace merlin {
namespace {

constexpr int kWidth_px = 1300, kHeader_px = 96, kPanel_px = 540;
constexpr double kLeft_px = 92, kRight_px = 960, kTop_px = 34, kBottom_px = 470;  // of a panel's plot
const cv::Scalar kGrid(230, 230, 228), kPlot(250, 250, 250);
const std::array<cv::Scalar, 6> kColors{cv::Scalar(180, 119, 31), cv::Scalar(40, 39, 214),   cv::Scalar(44, 160, 44),
                                        cv::Scalar(14, 127, 255), cv::Scalar(189, 103, 148), cv::Scalar(75, 86, 140)};

cv::Scalar ColorOf(const Series& series) { return kColors[static_cast<std::size_t>(series.color) % kColors.size()]; }

struct Place {
  Scale x, y;
  double top_px;

  Eigen::Vector2d Pixel(double at, double value) const {
    return {kLeft_px + x.Share(at) * (kRight_px - kLeft_px),
            top_px + kBottom_px - y.Share(value) * (kBottom_px - kTop_px)};
  }
  bool Shows(double at, double value) const {
    return std::isfinite(at) && std::isfinite(value) && (!x.logarithmic || at > 0.0) && (!y.logarithmic || value > 0.0);
  }
};

Place Fit(const Panel& panel, double top_px) {
  std::vector<double> at, values;
  for (const Series& series : panel.series) {
    at.insert(at.end(), series.x.begin(), series.x.end());
    values.insert(values.end(), series.y.begin(), series.y.end());
  }
  return {ScaleFor(at, panel.x), ScaleFor(values, panel.y), top_px};
}

void DrawAxes(Canvas& canvas, const Panel& panel, const Place& place) {
  const double top_px = place.top_px + kTop_px, bottom_px = place.top_px + kBottom_px;
  canvas.Fill({kLeft_px, top_px}, {kRight_px, bottom_px}, kPlot);
  for (const Tick& tick : place.x.ticks) {
    const double x_px = place.Pixel(tick.value, place.y.low).x();
    canvas.Line({{x_px, top_px}, {x_px, bottom_px}}, 1, kGrid);
    canvas.Text({x_px, bottom_px + 24}, tick.text, 11, kInk, TextAlign::kMiddle);
  }
  for (const Tick& tick : place.y.ticks) {
    const double y_px = place.Pixel(place.x.low, tick.value).y();
    canvas.Line({{kLeft_px, y_px}, {kRight_px, y_px}}, 1, kGrid);
    canvas.Text({kLeft_px - 10, y_px + 5}, tick.text, 11, kInk, TextAlign::kRight);
  }
  canvas.Line({{kLeft_px, top_px}, {kRight_px, top_px}, {kRight_px, bottom_px}, {kLeft_px, bottom_px}}, 1, kInk, true);
  canvas.Text({0.5 * (kLeft_px + kRight_px), bottom_px + 52}, panel.x.label, 13, kInk, TextAlign::kMiddle);
  canvas.Text({kLeft_px - 60, top_px - 14}, panel.y.label, 13, kInk);
}

void DrawSeries(Canvas& canvas, const Series& series, const Place& place) {
  const cv::Scalar color = ColorOf(series);
  std::vector<Eigen::Vector2d> stroke;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const bool shown = place.Shows(series.x[i], series.y[i]);
    if (shown && series.dots) canvas.Dot(place.Pixel(series.x[i], series.y[i]), 4, color);
    if (shown && !series.dots) stroke.push_back(place.Pixel(series.x[i], series.y[i]));
    if ((!shown || i + 1 == series.x.size()) && stroke.size() > 1) canvas.Line(stroke, 1.5, color);
    if (!shown) stroke.clear();
  }
}

void DrawLegend(Canvas& canvas, const Panel& panel, double top_px) {
  double y_px = top_px + kTop_px + 16;
  for (const Series& series : panel.series) {
    const double x_px = kRight_px + 20;
    if (series.dots)
      canvas.Dot({x_px + 15, y_px - 5}, 4, ColorOf(series));
    else
      canvas.Line({{x_px, y_px - 5}, {x_px + 30, y_px - 5}}, 2, ColorOf(series));
    canvas.Text({x_px + 42, y_px}, series.name, 11, kInk);
    y_px += 24;
  }
}

}  // namespace

std::string ToPng(const Figure& figure) {
  Canvas canvas(kWidth_px, kHeader_px + kPanel_px * static_cast<int>(figure.panels.size()));
  canvas.Text({kLeft_px - 60, 42}, figure.title, 19, kInk, TextAlign::kLeft, true);
  canvas.Text({kLeft_px - 60, 74}, figure.subtitle, 12, kInk);
  double top_px = kHeader_px;
  for (const Panel& panel : figure.panels) {
    const Place place = Fit(panel, top_px);
    DrawAxes(canvas, panel, place);
    for (const Series& series : panel.series) DrawSeries(canvas, series, place);
    DrawLegend(canvas, panel, top_px);
    top_px += kPanel_px;
  }
  return canvas.ToPng();
}

std::string ToCsv(const Figure& figure) {
  std::string csv = fmt::format("# {}\n# {}\n", figure.title, figure.subtitle);
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    csv += fmt::format("# panel {}: x = {}, y = {}\n", p, figure.panels[p].x.label, figure.panels[p].y.label);
  csv += "panel,series,kind,x,y\n";
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    for (const Series& series : figure.panels[p].series)
      for (std::size_t i = 0; i < series.x.size(); ++i)
        csv += fmt::format("{},\"{}\",{},{:.9g},{:.9g}\n", p, series.name, series.dots ? "samples" : "law", series.x[i],
                           series.y[i]);
  return csv;
}

}  // namespace merlin
