// The two-tap lock-in pixel and its converter. Each pixel collects electrons in two taps, A while the modulation is
// high and B while it is low; A - B in four sub-frames gives the phase.
// R. Lange, "3D time-of-flight distance measurement with custom solid-state image sensors in CMOS/CCD-technology", PhD
// thesis, Siegen 2000; the physical model of Schmidt and Jaehne, "A physical model of time-of-flight 3D imaging
// systems, including suppression of ambient light", LNCS 5742 (2009).
#pragma once

#include "robot/base/random.h"
#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "sim/tof/effects.h"

namespace merlin::sim {

// What a pixel collects in one sub-frame [e], both taps together: signal and background, and how unequally it is
// shared.
struct PixelLight {
  double total_e = 0.0;
  double correlation_e = 0.0;  // m_k = C Re(Z_1 e^(j tau_k) + ...), tau_k = k pi / 2
};

// How a pixel differs from the others.
struct PixelTraits {
  float gain = 0.0f;      // A grows by this share, and B shrinks by it
  float offset_e = 0.0f;  // of both taps
  bool dead = false;      // collects nothing
  bool hot = false;       // is always full
};

struct Taps {
  double a_e = 0.0, b_e = 0.0;
  bool saturated = false;                // one of them reached the full well
  double suppressed_e = 0.0;             // background removed from each tap (SBI) ...
  double suppression_variance_e2 = 0.0;  // ... and the noise that this added
};

// In this order: sharing, gain and offset, SBI, soft response, full well, noise, converter.
class Chip {
 public:
  Chip(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects);
  Taps Expose(const PixelLight& light, const PixelTraits& pixel, double integration_s, Random& random) const;
  // Of a - b, where taps are the expected ones: 0 without noise and adc.
  double DifferenceVariance_e2(const Taps& taps, double integration_s) const;
  double quantum_e() const { return quantum_e_; }  // one count of the converter

 private:
  double Noisy(double mean_e, double extra_variance_e2, Random& random) const;
  double Converted(double tap_e) const;

  TofEffects effects_;
  double full_well_e_, read_variance_e2_, dark_e_per_s_, response_cubic_;
  double sbi_onset_e_, sbi_max_e_, sbi_noise_;
  double quantum_e_, counts_max_, black_dn_;
  bool has_sbi_;
};

struct PhaseReading {
  double phase_rad = 0.0;    // [0, 2 pi)
  double amplitude_e = 0.0;  // sqrt(I^2 + Q^2) / 2
};
// D_k = a_k - b_k, I = D_0 - D_2, Q = D_3 - D_1, phase = atan2(Q, I).
PhaseReading DecodePhase(const Taps taps[4]);

// The four phase images of a pixel at rest are consistent: D_0 = -D_2, D_1 = -D_3. True if these deviate by more than
// 0.4 of the modulation and by more than four times the noise.
bool Inconsistent(const Taps taps[4], double amplitude_e, double read_noise_e);

// Standard deviation of range [m] for signal_e and background_e electrons of both taps in one sub-frame: the
// small-error law of this two-tap, four-phase estimator (Lange 2000).
double RangeSigma_m(double signal_e, double background_e, double contrast, double read_noise_e, double frequency_hz);

}  // namespace merlin::sim
