#include "tools/camera/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "scenarios/judge/canvas.h"

namespace merlin {
namespace {

constexpr double kImage_px = 620;  // the longer edge of each picture, about
constexpr double kMargin_px = 40, kTitle_px = 100, kCaption_px = 34, kBar_px = 160;
constexpr double kOutliers = 0.02;  // of the pixels may lie beyond a scale's end
const cv::Vec3b kNothing(150, 150, 150);

using Ramp = std::array<cv::Vec3b, 256>;

Ramp Viridis() {
  cv::Mat grey(256, 1, CV_8UC1), bgr;
  for (int i = 0; i < 256; ++i) grey.at<std::uint8_t>(i, 0) = static_cast<std::uint8_t>(i);
  cv::applyColorMap(grey, bgr, cv::COLORMAP_VIRIDIS);
  Ramp ramp;
  for (int i = 0; i < 256; ++i) ramp[static_cast<std::size_t>(i)] = bgr.at<cv::Vec3b>(i, 0);
  return ramp;
}

// Blue below zero, white, red above.
Ramp BlueRed() {
  Ramp ramp;
  for (int i = 0; i < 256; ++i) {
    const double share = std::abs(i - 127.5) / 127.5;
    const auto fade = [share](double full) {
      return static_cast<std::uint8_t>(std::lround(255.0 + share * (full - 255.0)));
    };
    ramp[static_cast<std::size_t>(i)] =
        i < 128 ? cv::Vec3b(fade(172), fade(102), fade(33)) : cv::Vec3b(fade(43), fade(24), fade(178));
  }
  return ramp;
}

struct View {
  std::string caption;
  std::vector<double> values;  // NaN: nothing
  double low = 0.0, high = 1.0;
  Ramp ramp;
};

double Quantile(std::vector<double> values, double share) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

cv::Mat Colored(const View& view, int width) {
  const int height = static_cast<int>(view.values.size()) / width;
  cv::Mat picture(height, width, CV_8UC3);
  for (std::size_t p = 0; p < view.values.size(); ++p) {
    const double share = std::clamp((view.values[p] - view.low) / (view.high - view.low), 0.0, 1.0);
    picture.at<cv::Vec3b>(static_cast<int>(p) / width, static_cast<int>(p) % width) =
        std::isfinite(view.values[p]) ? view.ramp[static_cast<std::size_t>(std::lround(255.0 * share))] : kNothing;
  }
  return picture;
}

void DrawBar(Canvas& canvas, const View& view, const Eigen::Vector2d& corner_px, double height_px) {
  for (int i = 0; i < 256; ++i) {
    const cv::Vec3b& color = view.ramp[static_cast<std::size_t>(i)];
    canvas.Fill({corner_px.x(), corner_px.y() + height_px * (255 - i) / 256.0},
                {corner_px.x() + 18, corner_px.y() + height_px * (256 - i) / 256.0},
                cv::Scalar(color[0], color[1], color[2]));
  }
  constexpr int kLabels = 4;
  for (int i = 0; i <= kLabels; ++i) {
    const double share = static_cast<double>(i) / kLabels, y_px = corner_px.y() + height_px * (1.0 - share);
    canvas.Line({{corner_px.x() + 18, y_px}, {corner_px.x() + 24, y_px}}, 1, kInk);
    canvas.Text({corner_px.x() + 30, y_px + 5}, fmt::format("{:.4g}", view.low + share * (view.high - view.low)), 11,
                kInk);
  }
}

std::array<View, 4> Views(const Measurement& m) {
  const std::size_t pixels = m.last.size();
  const double nan = std::nan(""), period_m = UnambiguousRange_m(m.last.settings);
  std::vector<double> truth(pixels, nan), range(pixels, nan), error(pixels, nan), amplitude(pixels, nan);
  for (std::size_t p = 0; p < pixels; ++p) {
    if (m.truth.range_m[p] > 0.0f) truth[p] = m.truth.range_m[p];
    if ((m.last.flags[p] & kInvalid) != 0) continue;
    range[p] = m.last.range_m[p];
    amplitude[p] = m.last.amplitude[p];
    error[p] = 1e3 * (UnwrapNear(range[p], truth[p], period_m) - truth[p]);
  }
  std::vector<double> both = truth, size;
  both.insert(both.end(), range.begin(), range.end());
  for (const double e : error) size.push_back(std::abs(e));
  const double near_m = Quantile(both, 0.0), far_m = std::max(near_m + 0.01, Quantile(both, 1.0 - kOutliers));
  const double error_mm = std::max(1.0, Quantile(size, 1.0 - kOutliers));
  const double amplitude_max_e = std::max(1.0, Quantile(amplitude, 1.0 - kOutliers));
  const Ramp viridis = Viridis();
  return {View{"true range [m]", truth, near_m, far_m, viridis},
          View{"measured range [m]", range, near_m, far_m, viridis},
          View{"measured less true range, without whole wraps [mm]", error, -error_mm, error_mm, BlueRed()},
          View{"amplitude [electrons]", amplitude, 0.0, amplitude_max_e, viridis}};
}

}  // namespace

std::string ToPng(const Measurement& m, const std::string& title, const std::string& subtitle) {
  const int scale = std::max(1, static_cast<int>(kImage_px / std::max(m.last.width, m.last.height)));
  const double width_px = m.last.width * scale, height_px = m.last.height * scale;
  const double column_px = std::max(width_px, 360.0) + kBar_px, row_px = height_px + kCaption_px + kMargin_px;
  Canvas canvas(static_cast<int>(kMargin_px + 2.0 * column_px), static_cast<int>(kTitle_px + 2.0 * row_px));
  canvas.Text({kMargin_px, 46}, title, 19, kInk, TextAlign::kLeft, true);
  canvas.Text({kMargin_px, 78}, subtitle, 12, kInk);
  int i = 0;
  for (const View& view : Views(m)) {
    const Eigen::Vector2d corner_px(kMargin_px + (i % 2) * column_px, kTitle_px + (i / 2) * row_px + kCaption_px);
    canvas.Text(corner_px - Eigen::Vector2d(0, 12), view.caption, 13, kInk);
    canvas.Picture(corner_px, Colored(view, m.last.width), scale);
    DrawBar(canvas, view, corner_px + Eigen::Vector2d(width_px + 14, 0), height_px);
    ++i;
  }
  return canvas.ToPng();
}

}  // namespace merlin
