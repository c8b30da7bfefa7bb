// Decides which depth pixels can be trusted. First it takes the camera's flags, then it looks for ghosts: pixels whose
// true range is beyond the unambiguous range (perception/filter/unwrap.h finds out about some). Then come pixels that
// their neighbours contradict. Accepted ranges are smoothed by a median. Every rejected pixel keeps its reason.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "robot/base/config.h"
#include "robot/types/depth_camera.h"

namespace merlin {

enum class Rejection : std::uint8_t {
  kNone,
  kInvalid,       // the camera saw no return
  kSaturated,     // a tap clipped: something is closer than the range says
  kInconsistent,  // the phase images disagree
  kLowSignal,     // too dark to measure
  kGhost,         // too dark for its range: a surface one unambiguous range farther away
  kLonely,        // too few neighbours agree
  kCount
};

struct DepthFilterConfig {
  // [0, 1] albedo of the brightest diffuse surface expected. A higher value rejects more; ghosts of brighter surfaces
  // pass.
  double ghost_albedo = 0.9;
  double agreement_share =
      0.12;  // [0, 1] neighbours agree within this share of the range: a wall seen at 11 deg; guess
  double agreement_floor_m = 0.05;  // [0, 1] and always within this; guess
  int neighbours_min = 3;           // [0, 8] of the 8 neighbours must agree; guess
};

template <class Visitor>
void Visit(Visitor& v, DepthFilterConfig& c) {
  v("ghost_albedo", c.ghost_albedo, {0.0, 1.0});
  v("agreement_share", c.agreement_share, {0.0, 1.0});
  v("agreement_floor_m", c.agreement_floor_m, {0.0, 1.0});
  v("neighbours_min", c.neighbours_min, {0.0, 8.0});
}

struct FilteredDepth {
  DepthFrame frame;                // ranges of accepted pixels: median of the agreeing 3x3 neighbourhood
  std::vector<Rejection> reasons;  // one per pixel
  std::array<int, static_cast<std::size_t>(Rejection::kCount)> counts{};
};

// True for a pixel that is darker than a surface at its range r should be, so that it may lie one unambiguous range U
// farther: its implied albedo, amplitude r^2 / lamp, is below ghost_albedo (r / (r + U))^2. One pixel does not know its
// angle of incidence, so very oblique dark surfaces are rejected too.
bool IsGhost(double range_m, double amplitude_e, double lamp_amplitude_e_m2, double unambiguous_m, double ghost_albedo);

// How far neighbours on one surface may lie apart [m].
inline double Agreement_m(double range_m, const DepthFilterConfig& config) {
  return std::max(config.agreement_floor_m, config.agreement_share * range_m);
}

// All steps in this order. The thesis (perception/pipeline.h) has amplitude, then median: eq. 4.6-4.8.
// Accepted ranges may be longer than the unambiguous range.
FilteredDepth FilterDepth(DepthFrame frame, const DepthCameraSheet& sheet, const DepthFilterConfig& config);

}  // namespace merlin
