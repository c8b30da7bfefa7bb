// Closes loops: a place recognised several times in a row joins the key frames of two visits, and the network of key
// frames (Lu and Milios) is laid out anew.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "slam/graph/optimize.h"
#include "slam/loop/find_loop.h"

namespace merlin {

class LoopCloser {
 public:
  explicit LoopCloser(const LoopConfig& config) : config_(config) {}

  // Looks for a former visit from the present pose. points_base: seen of late, in the present frame. Where a loop of the
  // newest key frame is found, the poses of all key frames that agree best with the ways between them, their headings
  // and the loops; planar: height and tilt stay, and the first pose. A place recognised where no new key frame was taken
  // needs no loop; one that strains the ways and headings more than their errors allow is none.
  std::optional<std::vector<Pose>> Search(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                                          const Pose& T_map_base, double path_m);
  bool IsDue(double path_m) const {
    return config_.enabled && path_m - searched_m_ >= (KnowsThePlace(path_m) ? config_.every_known_m : config_.every_m);
  }
  // A former visit was recognised so short a way ago that its key frames can be trusted here.
  bool KnowsThePlace(double path_m) const { return SinceLoop_m(path_m) < kKnown_m; }

  // Path since a former visit was last recognised; infinite: never.
  double SinceLoop_m(double path_m) const { return path_m - recognised_m_.value_or(-HUGE_VAL); }
  // Loops that join two key frames.
  int loops() const { return static_cast<int>(loops_.size()); }

 private:
  static constexpr double kKnown_m = 3.0;
  bool Agrees(const Loop& loop, const Pose& T_map_base);
  PoseGraph Network(std::span<const Keyframe> keyframes) const;

  LoopConfig config_;
  std::vector<GraphEdge> loops_;
  double searched_m_ = 0.0;
  std::optional<double> recognised_m_;
  std::optional<Pose> correction_;  // T_map_map of the last search
  int agreeing_ = 0;                // searches in a row that agreed with it
};

}  // namespace merlin
