// Draws the table as a picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/judge/canvas.h"
#include "tools/sweep/table.h"

namespace merlin {
namespace {

constexpr double kWidth_px = 1400, kRow_px = 26, kHeader_px = 96, kFooter_px = 70;
constexpr double kLeft_px = 450, kRight_px = 1360;  // left and right end of the plot
constexpr double kLow_m = 0.005, kHigh_m = 5.0;
const cv::Scalar kGrid(225, 225, 225), kGood(80, 140, 40), kBad(50, 50, 200), kDot(190, 140, 80), kLimit(60, 160, 230);

double X_px(double ate_m) {
  const double share = std::log(std::clamp(ate_m, kLow_m, kHigh_m) / kLow_m) / std::log(kHigh_m / kLow_m);
  return kLeft_px + share * (kRight_px - kLeft_px);
}

void DrawAxis(Canvas& canvas, double bottom_px) {
  for (const double tick_m : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0}) {
    canvas.Line({{X_px(tick_m), kHeader_px - 8}, {X_px(tick_m), bottom_px}}, 1.0, kGrid);
    canvas.Text({X_px(tick_m), kHeader_px - 14}, fmt::format("{:g} m", tick_m), 9, kInk, TextAlign::kMiddle);
  }
}

void DrawRow(Canvas& canvas, const SweepFigures& row, double y_px) {
  const bool kept = std::ranges::all_of(row.limits, &LimitOutcome::kept);
  canvas.Text({40, y_px + 5}, row.name, 10, row.limits.empty() ? kInk : kept ? kGood : kBad);
  canvas.Text({400, y_px + 5}, fmt::format("{}/{}", row.passed, row.runs), 10, row.passed == row.runs ? kGood : kBad,
              TextAlign::kRight);
  for (const LimitOutcome& limit : row.limits)
    if (limit.name == "ate_median_m_max" || limit.name == "ate_worst_m_max")
      canvas.Line({{X_px(limit.limit), y_px - 9}, {X_px(limit.limit), y_px + 9}}, 2.0, kLimit);
  if (!row.ate_m) return;
  const Interval& interval = row.ate_m->of_median;
  canvas.Line({{X_px(interval.low), y_px}, {X_px(interval.high), y_px}}, 2.0, kInk);
  for (const double ate_m : row.all_ate_m) canvas.Dot({X_px(ate_m), y_px}, 3.5, kDot);
  canvas.Line({{X_px(row.ate_m->median), y_px - 7}, {X_px(row.ate_m->median), y_px + 7}}, 3.0, kInk);
}

}  // namespace

std::string ToPng(const SweepTable& table) {
  const double bottom_px = kHeader_px + kRow_px * static_cast<double>(table.rows.size());
  Canvas canvas(static_cast<int>(kWidth_px), static_cast<int>(bottom_px + kFooter_px));
  canvas.Text({40, 40}, table.name, 16, kInk, TextAlign::kLeft, true);
  canvas.Text({400, kHeader_px - 14}, "passed", 9, kInk, TextAlign::kRight);
  canvas.Text({kRight_px, 40}, "path error (ATE) of completed runs", 11, kInk, TextAlign::kRight);
  DrawAxis(canvas, bottom_px);
  double y_px = kHeader_px + 0.5 * kRow_px;
  for (const SweepFigures& row : table.rows) {
    DrawRow(canvas, row, y_px);
    y_px += kRow_px;
  }
  canvas.Text({40, bottom_px + 40},
              "dot: a run; tick: median; bar: its interval; orange: limits of median and worst; red: a limit is missed",
              9, kInk);
  return canvas.ToPng();
}

}  // namespace merlin
