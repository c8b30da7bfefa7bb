// The errors of one model of time-of-flight camera: what the simulated sensor does to its measurements. The stack must
// not know them. A sheet (models/cameras/<name>.yaml, key `errors`) lists what differs from these defaults. Origins:
// (g) engineering guess, (m) recalled from the named paper; every one is a starting value for a calibration of the real
// camera.
#pragma once

#include "robot/base/config.h"

namespace merlin {

struct DepthCameraErrors {
  // Wiggling: harmonics of the correlation function, relative to the first. What a factory calibration leaves.
  double harmonic_3 = 0.04;            // (g) of the size in Lindner, Schiller, Kolb, Koch, CVIU 114(12), 2010
  double harmonic_5 = 0.005;           // (g)
  double wiggling_residual_m = 0.004;  // (g) rms

  // Converter, response.
  double adc_bits = 14.0;        // (g) 12 to 14
  double adc_black_dn = 200.0;   // (g) code of an empty tap
  double response_cubic = 0.02;  // (g) tap' = tap (1 - this (tap / full well)^2)
  double dark_e_per_us = 0.05;   // (g) both taps

  // Suppression of background illumination (Schmidt and Jaehne, LNCS 5742, 2009).
  double sbi_onset = 0.5;  // (g) starts once the emptier tap holds this much, in full wells
  double sbi_max = 50.0;   // (g) the most it takes away, in full wells
  double sbi_noise = 1.5;  // (g) variance it adds to a tap, per electron taken away

  // Ambient light.
  double lamp_w_per_sr = 2.0;      // (g) radiant intensity on the axis, both boards, mean over the modulation
  double filter_nm = 60.0;         // (g) width of the band filter
  double ambient_bias_m = 0.0075;  // (g) range error at a full well of ambient electrons: the two taps differ

  // Intensity-related error: what response and scatter do not explain (Lindner and Kolb, SPIE 6764, 2007).
  double intensity_bias_m =
      -0.02;  // (g) towards amplitude 0; falls with exp(-amplitude / that of albedo 0.2 at 3 m, 1 ms)

  // Fixed pattern: of the phase before and after calibration, of gain and offset of the taps.
  double pattern_white_m = 0.007;      // (m) pixel to pixel, one sigma
  double pattern_smooth_m = 0.03;      // (g) largest value of a quadratic over the picture
  double pattern_residual_m = 0.0015;  // (g) one sigma after calibration
  double tap_gain = 0.005;             // (g) one sigma: A grows by it, B shrinks
  double tap_offset_e = 50.0;          // (g) one sigma
  double dead_share = 0.0005;          // (g) of pixels that see nothing
  double hot_share = 0.0005;           // (g) of pixels that are always full

  // Lamp: two boards left and right of the lens.
  double lamp_baseline_m = 0.0;  // between the lens and each board's middle, along x
  double lamp_at_edge = 0.5;     // (g) Gaussian lobe: radiant intensity at the edge of the view, relative to the axis
  double lamp_width_m = 0.05;    // (g) edge of a board: how large its mirror image is

  // Scatter between lens and chip: share, spread as a Gaussian and evenly (Kavli et al. 2008 used empirical ones).
  double scatter_share = 0.01;  // (g) of the light, 0.01 to 0.05
  double scatter_sigma = 0.03;  // (g) of the Gaussian part, in picture widths
  double scatter_flat = 0.3;    // (g) share of the scattered light that spreads evenly

  // Temperature: drift = warmup (1 - exp(-t / time)) from cold, and with the room's temperature from 25 deg C on.
  double warmup_m = 0.025;         // (g) Piatti and Rinaudo, Remote Sens. 4(4), 2012: several cm
  double warmup_time_s = 600.0;    // (g) stable after about 40 min
  double ambient_m_per_k = 0.001;  // (g)
};

template <class Visitor>
void Visit(Visitor& v, DepthCameraErrors& c) {
  v("harmonic_3", c.harmonic_3, {0.0, 0.2});
  v("harmonic_5", c.harmonic_5, {0.0, 0.1});
  v("wiggling_residual_m", c.wiggling_residual_m, {0.0, 0.1});
  v("adc_bits", c.adc_bits, {6.0, 24.0});
  v("adc_black_dn", c.adc_black_dn, {0.0, 30.0e3});
  v("response_cubic", c.response_cubic, {0.0, 0.3});
  v("dark_e_per_us", c.dark_e_per_us, {0.0, 1e6});
  v("sbi_onset", c.sbi_onset, {0.0, 1.0});
  v("sbi_max", c.sbi_max, {0.0, 1e6});
  v("sbi_noise", c.sbi_noise, {1.0, 10.0});
  v("lamp_w_per_sr", c.lamp_w_per_sr, {1e-6, 1e4});
  v("filter_nm", c.filter_nm, {0.1, 1000.0});
  v("ambient_bias_m", c.ambient_bias_m, {-1.0, 1.0});
  v("intensity_bias_m", c.intensity_bias_m, {-0.5, 0.5});
  v("pattern_white_m", c.pattern_white_m, {0.0, 0.5});
  v("pattern_smooth_m", c.pattern_smooth_m, {0.0, 0.5});
  v("pattern_residual_m", c.pattern_residual_m, {0.0, 0.5});
  v("tap_gain", c.tap_gain, {0.0, 0.1});
  v("tap_offset_e", c.tap_offset_e, {0.0, 1e6});
  v("dead_share", c.dead_share, {0.0, 0.5});
  v("hot_share", c.hot_share, {0.0, 0.5});
  v("lamp_baseline_m", c.lamp_baseline_m, {0.0, 1.0});
  v("lamp_at_edge", c.lamp_at_edge, {0.01, 1.0});
  v("lamp_width_m", c.lamp_width_m, {1e-3, 1.0});
  v("scatter_share", c.scatter_share, {0.0, 0.5});
  v("scatter_sigma", c.scatter_sigma, {0.0, 1.0});
  v("scatter_flat", c.scatter_flat, {0.0, 1.0});
  v("warmup_m", c.warmup_m, {-0.5, 0.5});
  v("warmup_time_s", c.warmup_time_s, {1.0, 1e5});
  v("ambient_m_per_k", c.ambient_m_per_k, {-0.1, 0.1});
}

}  // namespace merlin
