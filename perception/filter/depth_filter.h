// Decides which depth pixels to believe. Every rejected pixel keeps its reason.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "robot/base/config.h"
#include "robot/types/depth_camera.h"

namespace merlin {

enum class Rejection : std::uint8_t {
  kNone,
  kInvalid,       // the camera saw no return
  kSaturated,     // a tap clipped: something is there, nearer than the range says
  kInconsistent,  // the phase images disagree
  kLowSignal,     // too dark to measure
  kGhost,         // too dark for its range: a surface one unambiguous range farther away
  kLonely,        // too few neighbours agree
  kCount
};

struct DepthFilterConfig {
  double ghost_albedo = 0.9;  // [0, 1] brightest diffuse surface expected; higher rejects more. Below it a ghost passes
  double agreement_share =
      0.12;  // [0, 1] neighbours within this share of the range agree; guess: a wall seen at 11 deg
  double agreement_floor_m = 0.05;  // [0, 1] and always within this
  int neighbours_min = 3;           // [0, 8] of 8 that must agree; guess
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
  std::vector<Rejection> reasons;  // one a pixel
  std::array<int, static_cast<std::size_t>(Rejection::kCount)> counts{};
};

// True if a pixel is darker than any surface at its range should be, so that it must lie an unambiguous range U farther:
// its implied albedo amplitude r^2 / lamp is below ghost_albedo (r / (r + U))^2. Departure from a physical test of the
// incidence angle, which one pixel does not know: very oblique dark surfaces are rejected too.
bool IsGhost(double range_m, double amplitude_e, double lamp_amplitude_e_m2, double unambiguous_m, double ghost_albedo);

// Camera flags, ghosts, then agreement with neighbours and the median (thesis eq. 4.6-4.8: amplitude, then median).
FilteredDepth FilterDepth(DepthFrame frame, const DepthCameraSheet& sheet, const DepthFilterConfig& config);

}  // namespace merlin
