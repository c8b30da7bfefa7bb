// The light of a frame: all light that reaches each pixel from lamp, sun and sky, on every path, before the chip.
//
// What changes little during a frame is computed once, at mid-exposure (class Still): panes and mirrors, lamp shadows,
// ambient light, the bounce. Each sub-frame then traces again what motion of the camera or the bodies can change:
//
//   Expose   for each sub-frame: move the bodies to its middle, then for each row of pixels
//              SubFrameTracer::Row   ranges and normals
//              RowPhasors            electrons and phases, summed per pixel
//              AddOffsets            phase errors that depend on the light itself
//              Correlate             what the chip's demodulation makes of them at tau_k = k pi / 2
#pragma once

#include <cstdint>
#include <vector>

#include "sim/tof/ambient.h"
#include "sim/tof/calibration.h"
#include "sim/tof/multipath.h"
#include "sim/tof/phasors.h"
#include "sim/tof/scatter.h"
#include "sim/tof/view.h"

namespace merlin::sim {

// What the pixels collect in one sub-frame: electrons of both taps, and how they are shared between the taps (chip.h).
struct LightImages {
  std::vector<float> total_e, correlation_e;
  std::vector<std::uint8_t> lit;  // some light of the lamp has come back
};

class LightModel {
 public:
  LightModel(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects, int threads);

  // One result for each sub-frame. Afterwards the bodies of the scene are at their poses in the last one.
  std::vector<LightImages> Expose(const TofView& view, const DepthSettings& settings, const FixedPattern& pattern,
                                  const Drift& drift) const;
  std::vector<SubFrame> SubFrames(const DepthSettings& settings) const;
  const Optics& optics() const { return optics_; }

 private:
  // What all sub-frames share, computed at mid-exposure.
  struct Still {
    explicit Still(const Optics& optics) : mid(optics) {}
    MidHits mid;
    std::vector<float> lamp_albedo;  // [geom]
    std::vector<ExtraReturn> extra;
    std::vector<std::size_t> extra_from;  // [row], and the end
    std::vector<std::uint8_t> shadow;
    std::vector<float> ambient;   // [pixel] albedo times irradiance; empty: dark
    std::vector<Phasors> bounce;  // [pixel] for the present frequency; empty: none
  };
  // What is specific to a sub-frame.
  struct Now {
    const SubFrameTracer* tracer;  // null if nothing moves
    double frequency_hz, integration_s;
    int k;  // which of the four sub-frames of a frequency
  };
  Still TakeStill(const TofView& view) const;
  LightImages Expose(const Still& still, const Now& now, const FixedPattern& pattern, const Drift& drift) const;
  std::vector<Phasors> Bounce(const TofView& view, const Still& still, double frequency_hz, double integration_s) const;
  struct RowScratch;
  void ExposeRow(const Still& still, const Now& now, const FixedPattern& pattern, const Drift& drift, int v,
                 RowScratch& scratch, LightImages& images) const;
  void AddOffsets(double contrast, RowScratch& scratch) const;
  bool Moves(const TofView& view) const;
  std::vector<std::uint8_t> Calm(const TofView& view, const MidHits& mid, const DepthSettings& settings) const;

  DepthCameraSheet sheet_;
  DepthCameraErrors errors_;
  TofEffects effects_;
  int threads_;
  Optics optics_;
  Scatter scatter_;
};

}  // namespace merlin::sim
