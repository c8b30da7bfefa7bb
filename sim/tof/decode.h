// Turns the taps of four (or eight) sub-frames into a frame: phase and from it range, amplitude, intensity, flags. The
// factory calibration is subtracted here. The manufacturer's post-processing follows if the settings ask for it.
#pragma once

#include <span>
#include <vector>

#include "robot/types/depth_camera.h"
#include "sim/tof/calibration.h"
#include "sim/tof/chip.h"

namespace merlin::sim {

class Decoder {
 public:
  // pattern and corrections must outlive this. corrections: for every frequency in use, or none at all.
  Decoder(const DepthCameraSheet& sheet, const DepthSettings& settings, const FixedPattern& pattern,
          std::span<const WigglingCorrection> corrections, const Drift& drift);

  DepthFrame EmptyFrame(Time stamp, std::uint64_t index) const;
  // taps: of the sub-frames of the settings. lit: some light of the lamp has come back.
  void Decode(std::span<const Taps> taps, bool lit, std::size_t pixel, DepthFrame& frame) const;

 private:
  // One of the frame's frequencies, and the correction of its wiggling (null: none).
  struct Wave {
    double frequency_hz, period_m;
    const WigglingCorrection* correction;
  };
  double Range_m(double phase_rad, const Wave& wave, double known_m) const;

  const FixedPattern& pattern_;
  DepthSettings settings_;
  int width_, height_;
  double read_noise_e_, full_well_e_, low_signal_e_;
  double known_drift_m_;
  double unambiguous_m_;
  std::vector<Wave> waves_;
};

// Resolves two wrapped ranges to the one range that fits both: the pair of periods whose ranges differ least, averaged
// with weights (f amplitude)^2, the inverse variances. Correct while the errors differ by less than half the smallest
// distance between multiples of the two periods: 1.249 m at 20 and 30 MHz (Droeschel, Holz, Behnke, IROS 2010).
struct WrappedRange {
  double range_m = 0.0, period_m = 0.0, weight = 0.0;
};
double Unwrap_m(const WrappedRange& first, const WrappedRange& second, double unambiguous_m);

// The manufacturer's post-processing: pixels of low amplitude become kInvalid with range 0, then a 3x3 median over the
// valid ones.
void PostProcess(DepthFrame& frame);

}  // namespace merlin::sim
