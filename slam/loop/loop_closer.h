// Closes loops. Where a place of an earlier visit is recognised several times in a row, an edge joins the key frames of
// the two visits, and the graph of all key frames is optimised (F. Lu and E. Milios, "Globally consistent range scan
// alignment for environment mapping", Autonomous Robots 4, 1997). A loop that contradicts odometry and headings is
// refused.
//
//   edges of the graph            measured by
//   key frame to the next one     registration, while driving
//   world to key frame            heading; yaw only
//   key frame to a former one     closed loop
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

  // Searches for a former visit at the present pose. points_base: the newest points, in the present frame. Where a loop
  // of the newest key frame is closed: the poses of all key frames that agree best with the steps between them, their
  // headings and the loops. Height, roll and pitch stay, and so does the first pose. A place recognised where no new
  // key frame was taken needs no loop. A loop that adds more than strain_max to chi2 is refused.
  std::optional<std::vector<Pose>> Search(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                                          const Pose& T_map_base, double path_m);
  bool IsDue(double path_m) const {
    return config_.enabled && path_m - searched_m_ >= (KnowsThePlace(path_m) ? config_.every_known_m : config_.every_m);
  }
  // A former visit was recognised on the last kKnown_m: its key frames can be trusted here.
  bool KnowsThePlace(double path_m) const { return SinceLoop_m(path_m) < kKnown_m; }

  // Distance driven since a former visit was last recognised; infinite where none was.
  double SinceLoop_m(double path_m) const { return path_m - recognised_m_.value_or(-HUGE_VAL); }
  // Loops closed so far, and the edges of all loops that the map has.
  int loops() const { return static_cast<int>(loops_.size() - joined_); }
  const std::vector<GraphEdge>& edges() const { return loops_; }

  // A former map was put before the key frames: its loops, the number of its key frames, and the place of the newest key
  // frame in it. keyframes: all, in the former map's frame.
  void Join(const std::vector<GraphEdge>& former, std::size_t former_keyframes, std::span<const Keyframe> keyframes,
            const Loop& place, double path_m);

 private:
  static constexpr double kKnown_m = 3.0;
  bool Agrees(const Loop& loop, const Pose& T_map_base);
  PoseGraph Graph(std::span<const Keyframe> keyframes) const;

  LoopConfig config_;
  std::vector<GraphEdge> loops_;
  std::size_t joined_ = 0;  // of them: those of the former map, and the one that joined it
  double searched_m_ = 0.0;
  std::optional<double> recognised_m_;
  std::optional<Pose> correction_;  // T_map_map of the last search
  int agreeing_ = 0;                // searches in a row that agree with it
};

}  // namespace merlin
