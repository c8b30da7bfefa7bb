// The light of a frame: every way it takes from lamp, sun and sky to the pixels, sub-frame by sub-frame, up to the
// chip.
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

// What the pixels collect in one sub-frame: electrons of both taps, and how they are shared (chip.h).
struct LightImages {
  std::vector<float> total_e, correlation_e;
  std::vector<std::uint8_t> lit;  // something came back from the lamp
};

class LightModel {
 public:
  LightModel(const DepthCameraSheet& sheet, const DepthCameraErrors& errors, const TofEffects& effects, int threads);

  // [sub-frame]. The scene is left as it is at the last one.
  std::vector<LightImages> Expose(const TofView& view, const DepthSettings& settings, const FixedPattern& pattern,
                                  const Drift& drift) const;
  std::vector<SubFrame> SubFrames(const DepthSettings& settings) const;
  const Optics& optics() const { return optics_; }

 private:
  // What is the same for every sub-frame: taken at mid-exposure.
  struct Still {
    explicit Still(const Optics& optics) : mid(optics) {}
    MidHits mid;
    std::vector<float> lamp_albedo;  // [geom]
    std::vector<ExtraReturn> extra;
    std::vector<std::size_t> extra_from;  // [row], and the end
    std::vector<std::uint8_t> shadow;
    std::vector<float> ambient;   // [pixel] albedo times irradiance; empty: dark
    std::vector<Phasors> bounce;  // [pixel] for the frequency at hand; empty: none
  };
  // What a sub-frame adds to it.
  struct Now {
    const SubFrameTracer* tracer;  // none: nothing moves
    double frequency_hz, integration_s;
    int k;  // of its four
  };
  Still TakeStill(const TofView& view) const;
  LightImages Expose(const Still& still, const Now& now, const FixedPattern& pattern, const Drift& drift) const;
  std::vector<Phasors> Bounce(const TofView& view, const Still& still, double frequency_hz, double integration_s) const;
  struct RowRoom;
  void ExposeRow(const Still& still, const Now& now, const FixedPattern& pattern, const Drift& drift, int v,
                 RowRoom& room, LightImages& images) const;
  void AddOffsets(double contrast, RowRoom& room) const;
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
