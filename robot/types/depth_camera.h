// What a time-of-flight camera is and what it delivers.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/types/camera_model.h"
#include "robot/types/time.h"

namespace merlin {

constexpr double kSpeedOfLight_m_s = 299792458.0;

// Bits of DepthFrame::flags, as the PMD SDK has them (pmdGetFlags).
enum DepthFlag : std::uint8_t {
  kInvalid = 1,       // no return
  kSaturated = 2,     // a tap clipped: there is a range, but it is wrong
  kInconsistent = 4,  // the four phase images disagree (motion)
  kLowSignal = 8,     // amplitude below the sheet's threshold
  kSbiActive = 16,    // background suppression worked
};

struct DepthSettings {
  double integration_s = 1e-3;       // of one sub-frame; four of them (eight with two frequencies) are one frame
  double frequency_hz = 20e6;        // modulation
  double second_frequency_hz = 0.0;  // 0: none; else four more sub-frames, and a range that wraps later
  bool post_processing = false;      // the maker's own: pixels of low amplitude become invalid, a 3x3 median of range
  bool phase_images = false;         // deliver the taps, too

  int sub_frames() const { return second_frequency_hz > 0.0 ? 8 : 4; }
};

// Range at which the phase wraps: c / 2f. 7.495 m at 20 MHz.
inline double UnambiguousRange_m(double frequency_hz) { return kSpeedOfLight_m_s / (2.0 * frequency_hz); }
// With two frequencies: that of their greatest common divisor. 14.990 m at 20 and 30 MHz.
inline double UnambiguousRange_m(const DepthSettings& settings) {
  const auto hz = [](double frequency_hz) { return static_cast<long long>(std::llround(frequency_hz)); };
  return UnambiguousRange_m(static_cast<double>(std::gcd(hz(settings.frequency_hz), hz(settings.second_frequency_hz))));
}

// The data sheet of one model of camera. models/cameras/<name>.yaml has the values and their origin.
struct DepthCameraSheet {
  std::string name;
  CameraModel camera;
  double rate_max_hz = 0.0;
  double latency_s = 0.0;               // from mid-exposure to the stack: read-out, bus, driver
  double signal_e_m2_per_us = 0.0;      // K: electrons of both taps in one sub-frame = K rho cos(theta) T / d^2
  double contrast_at_20mhz = 0.0;       // C, demodulation contrast
  double contrast_corner_hz = 0.0;      // f_c of C(f) = C0 / sqrt(1 + (f / f_c)^2)
  double read_noise_e = 0.0;            // per tap, one sigma
  double full_well_e = 0.0;             // per tap
  bool sbi = false;                     // the chip suppresses background illumination
  double readout_s = 0.0;               // between two sub-frames
  double low_signal_amplitude_e = 0.0;  // below it a pixel is flagged kLowSignal
  double integration_min_s = 0.0;
  double integration_max_s = 0.0;
  std::vector<double> frequencies_hz;

  double Contrast(double frequency_hz) const {
    const auto falloff = [this](double f_hz) { return std::hypot(1.0, f_hz / contrast_corner_hz); };
    return contrast_at_20mhz * falloff(20e6) / falloff(frequency_hz);
  }
  // Amplitude [e] of a facing surface of albedo 1 at 1 m: amplitude = this * rho cos(theta) / d^2.
  double LampAmplitude_e_m2(const DepthSettings& settings) const {
    return Contrast(settings.frequency_hz) * signal_e_m2_per_us * settings.integration_s * 1e6;
  }
  // From the start of the first sub-frame to the end of the last.
  double ExposureSpan_s(const DepthSettings& settings) const {
    return settings.sub_frames() * settings.integration_s + (settings.sub_frames() - 1) * readout_s;
  }
};

// Throws InputError for settings the sheet does not list as valid.
void CheckSettings(const DepthCameraSheet& sheet, const DepthSettings& settings);

// The valid settings closest to these. Throws InputError for NaN.
DepthSettings NearestSettings(const DepthCameraSheet& sheet, const DepthSettings& settings);

// One measurement. Images are row-major, width x height, upper left first, as the camera sees.
struct DepthFrame {
  Time stamp{0};            // middle of the whole exposure (four sub-frames)
  std::uint64_t index = 0;  // counts frames from the start of the run
  DepthSettings settings;
  int width = 0;
  int height = 0;
  std::vector<float> range_m;           // along the ray, [0, UnambiguousRange_m(settings)); what lies beyond wraps
  std::vector<float> amplitude;         // electrons: sqrt(I^2 + Q^2) / 2 = C N_s; with two frequencies the first one's
  std::vector<std::uint8_t> intensity;  // mean of a sub-frame's taps, 255 at the full well
  std::vector<std::uint8_t> flags;      // DepthFlag bits
  std::vector<float> phase_images;  // taps [e], sub-frame by sub-frame, image of A then of B; empty unless asked for

  std::size_t size() const { return range_m.size(); }
};

}  // namespace merlin
