#include "tools/camera/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/tof/tof_camera.h"

namespace merlin {
namespace {

std::size_t CenterPixel(const CameraModel& camera) {
  return static_cast<std::size_t>(camera.height / 2) * static_cast<std::size_t>(camera.width) +
         static_cast<std::size_t>(camera.width / 2);
}

// Whether a pixel is in the middle third of the rows and of the columns; at least one pixel is.
std::vector<std::size_t> MiddleNinth(const CameraModel& camera) {
  std::vector<std::size_t> pixels;
  const auto end = [](int n) { return std::max(n / 3 + 1, n - n / 3); };
  for (int v = camera.height / 3; v < end(camera.height); ++v)
    for (int u = camera.width / 3; u < end(camera.width); ++u)
      pixels.push_back(static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(u));
  return pixels;
}

class Sums {
 public:
  Sums(std::vector<float> truth_m, std::size_t center, double period_m)
      : reference_m_(std::move(truth_m)), period_m_(period_m) {
    wraps_m_ = period_m * std::floor(reference_m_[center] / period_m);
    pixels_.resize(reference_m_.size());
  }

  void Add(const DepthFrame& frame) {
    for (std::size_t p = 0; p < frame.size(); ++p) {
      saturated_ += (frame.flags[p] & kSaturated) != 0 ? 1 : 0;
      if ((frame.flags[p] & kInvalid) != 0) continue;
      ++valid_;
      amplitude_e_ += frame.amplitude[p];
      const bool known = reference_m_[p] > 0.0f;
      pixels_[p].Add(known ? UnwrapNear(frame.range_m[p], reference_m_[p] - wraps_m_, period_m_) : frame.range_m[p]);
    }
    shown_ += frame.size();
  }

  void Give(const CameraModel& camera, Measurement& m) const {
    std::vector<PixelSamples> middle;
    for (const std::size_t p : MiddleNinth(camera)) middle.push_back(pixels_[p]);
    m.center = Pool({pixels_[CenterPixel(camera)]});
    m.middle = Pool(middle);
    m.whole = Pool(pixels_);
    m.valid_share = static_cast<double>(valid_) / static_cast<double>(shown_);
    m.saturated_share = static_cast<double>(saturated_) / static_cast<double>(shown_);
    m.amplitude_mean = valid_ == 0 ? 0.0 : amplitude_e_ / static_cast<double>(valid_);
  }

 private:
  std::vector<float> reference_m_;
  double period_m_, wraps_m_ = 0.0, amplitude_e_ = 0.0;
  std::vector<PixelSamples> pixels_;
  std::size_t shown_ = 0, valid_ = 0, saturated_ = 0;
};

}  // namespace

Measurement Measure(const Shooting& shooting, const sim::TofView& view, const std::atomic<bool>& interrupted) {
  sim::TofCamera camera(shooting.sheet, shooting.errors, shooting.effects, shooting.seed, shooting.threads);
  DepthSettings settings = shooting.settings;
  settings.phase_images = true;
  const double span_s = shooting.sheet.ExposureSpan_s(settings);
  const double period_s = std::max(1.0 / shooting.sheet.rate_max_hz, span_s);
  const auto stamp = [&](int i) { return FromSeconds(0.5 * span_s + i * period_s); };

  Measurement m;
  m.truth = camera.Truth(view, settings, stamp(shooting.frames - 1));
  const std::size_t center = CenterPixel(shooting.sheet.camera);
  m.true_center_m = m.truth.range_m[center];
  Sums sums(m.truth.range_m, center, UnambiguousRange_m(settings));
  std::vector<double> frame_ms;
  for (int i = 0; i < shooting.frames && !(i > 0 && interrupted); ++i) {
    const auto start = std::chrono::steady_clock::now();
    m.last = camera.Expose(view, settings, stamp(i), static_cast<std::uint64_t>(i));
    frame_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    sums.Add(m.last);
  }
  sums.Give(shooting.sheet.camera, m);
  m.frame_ms = Median(frame_ms);
  return m;
}

}  // namespace merlin
