// Recognises a place that was mapped on an earlier visit. First it selects key frames whose view lies near the present
// one. Then it registers the newest points against their map: coarsely, then finely. The place is recognised where
// enough points meet the map, lie on its surfaces, and tell the position in both directions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "robot/base/config.h"
#include "slam/keyframe.h"
#include "slam/register/icp.h"

namespace merlin {

struct LoopConfig {
  bool enabled = true;  // false: the map stays as it was driven

  // When and where to search.
  double apart_m = 12.0;       // [1, 1e4] distance driven between two visits; less is no loop
  double every_m = 0.25;       // [0.05, 100] distance driven between two searches...
  double every_known_m = 2.0;  // [0.05, 2.5] ...and between two where a former visit was just recognised
  double reach_m = 1.5;        // [0.1, 100] between the centres of two views of one place,...
  double reach_share = 0.01;   // [0, 1] ...plus this share of the distance driven since: the drift of the estimate
  double turn_rad = 0.8;       // [0.01, 3.2] between the directions of two views of one place

  // When a place is recognised.
  double start_sigma_m = 0.3;     // [0.001, 10] one sigma of the estimated position before registration; guess
  double start_sigma_rad = 0.02;  // [1e-4, 3] and of its yaw; guess
  double overlap_min = 0.15;      // [0, 1] share of the points near the former map; little at the start of a loop
  double on_surface_min = 0.65;   // [0, 1] share of those that lie on its surfaces, not before or behind them
  double rms_max_m = 0.035;       // [1e-3, 1] of the inliers' distances from it
  double sigma_max_m = 0.05;      // [1e-3, 10] one sigma of the position, in the direction that is known worst
  int agreeing_min = 2;           // [1, 100] searches in a row must agree on the correction
  double agreeing_m = 0.05;       // [1e-3, 10] within this distance, and the same number of rad
  double chi2_max = 21.1;         // [1, 1e6] of a loop against the drift: 99.99 % of right ones, 3 degrees of freedom

  // Weights of the graph of key frames: standard deviations.
  double path_sigma_m_per_sqrt_m = 0.012;    // [1e-5, 1] of a step between key frames, by the root of its length; guess
  double turn_sigma_rad_per_sqrt_m = 0.002;  // [1e-5, 1] of its turn; guess
  double corner_sigma_rad_per_sqrt_rad = 0.025;  // [1e-5, 1] without a heading, of a turn, by its root; see the graph
  double loop_sigma_m = 0.01;                    // [1e-4, 10] of a loop, added to what registration says; guess
  double loop_sigma_rad = 0.003;                 // [1e-5, 1] the same for its turn; guess
  double heading_sigma_rad = 0.02;  // [1e-4, 3] of a key frame's heading; large, because neighbours err alike; guess
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
  v("chi2_max", c.chi2_max, {1.0, 1e6});
  v("path_sigma_m_per_sqrt_m", c.path_sigma_m_per_sqrt_m, {1e-5, 1.0});
  v("turn_sigma_rad_per_sqrt_m", c.turn_sigma_rad_per_sqrt_m, {1e-5, 1.0});
  v("corner_sigma_rad_per_sqrt_rad", c.corner_sigma_rad_per_sqrt_rad, {1e-5, 1.0});
  v("loop_sigma_m", c.loop_sigma_m, {1e-4, 10.0});
  v("loop_sigma_rad", c.loop_sigma_rad, {1e-5, 1.0});
  v("heading_sigma_rad", c.heading_sigma_rad, {1e-4, 3.0});
}

struct Loop {
  std::size_t former = 0;                  // index of the key frame that recognised the place
  Pose T_map_base = Pose::Identity();      // the present frame, as registered against the former map
  Matrix6d covariance = Matrix6d::Zero();  // over (translation, rotation) in the base frame
  double overlap = 0.0;                    // share of points near the former map
};

// How well points fit to what some key frames saw.
struct PlaceFit {
  RegisterResult fit;       // the key frames' map is the target
  double sigma_m = 0.0;     // one sigma of the position, in the direction that is known worst
  double near = 0.0;        // share of the points near the key frames' map
  double on_surface = 0.0;  // share of the points on its surfaces
};

// Registers the points against the map of these key frames, coarsely, then finely. views: indices of key frames.
// T_map_base: where it starts; converges from some 0.3 m and 0.05 rad away.
PlaceFit FitToViews(std::span<const Keyframe> keyframes, std::span<const std::size_t> views,
                    std::span<const Point> points_base, const Pose& T_map_base, const LoopConfig& config);
// The shapes are the same. Whether they determine the position is another question: see sigma_m.
bool Fits(const PlaceFit& fit, const LoopConfig& config);

// points_base: the newest points, in the present frame. Nothing where no key frame of an earlier visit sees the place,
// or the shapes do not fit, or do not determine the position.
std::optional<Loop> FindLoop(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                             const Pose& T_map_base, double path_m, const LoopConfig& config);

}  // namespace merlin
