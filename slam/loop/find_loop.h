// Recognises a place that was mapped long before: by where it lies, then by its shape.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "robot/base/config.h"
#include "slam/keyframe.h"
#include "slam/register/icp.h"

namespace merlin {

struct LoopConfig {
  bool enabled = true;         // off: the map is left as it was driven
  double apart_m = 12.0;       // [1, 1e4] driven between two visits; less is no loop
  double every_m = 0.25;       // [0.05, 100] driven between two searches
  double every_known_m = 2.0;  // [0.05, 2.5] and where a former visit was just recognised
  double reach_m = 1.5;        // [0.1, 100] between the middles of two views of one place...
  double reach_share = 0.01;   // [0, 1] ...and this share of the way since the former, which the estimate may be off by
  double turn_rad = 0.8;       // [0.01, 3.2] between their directions
  double start_sigma_m = 0.3;  // [0.001, 10] the estimate's error before it is compared; guess
  double start_sigma_rad = 0.02;  // [1e-4, 3] and of its direction; guess
  double overlap_min = 0.15;  // [0, 1] of its points must lie near the former map: of a loop's first frames little does
  double on_surface_min = 0.65;  // [0, 1] and of those on its surfaces, not before or behind them
  double rms_max_m = 0.035;      // [1e-3, 1] of their distances from it
  double sigma_max_m = 0.05;     // [1e-3, 10] the shape must tell the place this well in both directions
  int agreeing_min = 2;          // [1, 100] searches in a row whose corrections agree make a loop
  double agreeing_m = 0.05;      // [1e-3, 10] within this, and the same number of rad
  double strain_max = 30.0;      // [1, 1e6] chi2 that it may add to ways and headings: 99.99 % of 6 degrees of freedom
  double path_sigma_m_per_sqrt_m = 0.012;    // [1e-5, 1] of the way between key frames, by its root; guess
  double turn_sigma_rad_per_sqrt_m = 0.002;  // [1e-5, 1] of its direction; guess
  double loop_sigma_m = 0.01;                // [1e-4, 10] of a loop, and at least; guess
  double loop_sigma_rad = 0.003;             // [1e-5, 1]
  double heading_sigma_rad = 0.02;           // [1e-4, 3] of one key frame's heading: neighbours err alike; guess
};

template <class Visitor>
void Visit(Visitor& v, LoopConfig& c) {
  v("enabled", c.enabled);
  v("apart_m", c.apart_m, {1.0, 1e4});
  v("every_m", c.every_m, {0.05, 100.0});
  v("every_known_m", c.every_known_m, {0.05, 2.5});
  v("reach_m", c.reach_m, {0.1, 100.0});
  v("reach_share", c.reach_share, {0.0, 1.0});
  v("turn_rad", c.turn_rad, {0.01, 3.2});
  v("start_sigma_m", c.start_sigma_m, {0.001, 10.0});
  v("start_sigma_rad", c.start_sigma_rad, {1e-4, 3.0});
  v("overlap_min", c.overlap_min, {0.0, 1.0});
  v("on_surface_min", c.on_surface_min, {0.0, 1.0});
  v("rms_max_m", c.rms_max_m, {1e-3, 1.0});
  v("sigma_max_m", c.sigma_max_m, {1e-3, 10.0});
  v("agreeing_min", c.agreeing_min, {1.0, 100.0});
  v("agreeing_m", c.agreeing_m, {1e-3, 10.0});
  v("strain_max", c.strain_max, {1.0, 1e6});
  v("path_sigma_m_per_sqrt_m", c.path_sigma_m_per_sqrt_m, {1e-5, 1.0});
  v("turn_sigma_rad_per_sqrt_m", c.turn_sigma_rad_per_sqrt_m, {1e-5, 1.0});
  v("loop_sigma_m", c.loop_sigma_m, {1e-4, 10.0});
  v("loop_sigma_rad", c.loop_sigma_rad, {1e-5, 1.0});
  v("heading_sigma_rad", c.heading_sigma_rad, {1e-4, 3.0});
}

struct Loop {
  std::size_t former = 0;                  // the key frame it was recognised by
  Pose T_map_base = Pose::Identity();      // where the former map has the present frame
  Matrix6d covariance = Matrix6d::Zero();  // over (translation, rotation) in the base frame
  double overlap = 0.0;                    // share of points near the former map
};

// points_base: what was seen of late, in the present frame. Nothing: no key frame of an earlier visit sees the place, or
// the shapes do not fit, or do not tell where along them the car is.
std::optional<Loop> FindLoop(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                             const Pose& T_map_base, double path_m, const LoopConfig& config);

}  // namespace merlin
