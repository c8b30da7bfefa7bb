// Closes loops. Where a place of an earlier visit is recognised several times in a row, an edge joins the key frames of
// the two visits, and the graph of all key frames is optimised (F. Lu and E. Milios, "Globally consistent range scan
// alignment for environment mapping", Autonomous Robots 4, 1997).
//
//   edges of the graph            measured by                     error
//   key frame to the next one     registration, while driving     grows with the distance; without a heading, also with
//                                                                 the turn: a compass would have bounded it
//   world to key frame            heading; yaw only
//   key frame to a former one     loop                            of the registration; the loop may be wrong as a whole
//   first key frame of a run      place in the map of a former    of the registration; never doubted: nothing else holds
//   to a former one               run (slam/place_search.h)       the two runs together
//
// Two tests keep a wrong loop out of the map. First, a loop must agree with the drift that the other edges imply: chi2 of
// its difference from them. Second, the loops must agree with each other. Their edges are robust, and after each closed
// loop those with too large a chi2 are left out of the graph. They remain candidates: a later loop may side with them.
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

  // Searches for a former visit at the present pose. points_base: the newest points, in the present frame. keyframes: all;
  // once a run has ended the present pose may be that of any of them. Returns what Take does.
  std::optional<std::vector<Pose>> Search(std::span<const Keyframe> keyframes, std::span<const Point> points_base,
                                          const Pose& T_map_base, double path_m);
  // Takes the result of one search at T_map_base; loop: empty where it found none. Where enough of them agree in a row, it
  // closes the loop. A place recognised where no new key frame was taken needs no loop.
  std::optional<std::vector<Pose>> Take(std::span<const Keyframe> keyframes, const std::optional<Loop>& loop,
                                        const Pose& T_map_base, double path_m);
  // Adds a loop from a former key frame to the one at path_m. Returns the poses of all key frames that agree best with the
  // steps between them, their headings and the loops. Height, roll and pitch stay, and so does the first pose. Nothing
  // where the loop contradicts the drift or the other loops.
  std::optional<std::vector<Pose>> Close(std::span<const Keyframe> keyframes, const Loop& loop, const Pose& T_map_base,
                                         double path_m);
  bool IsDue(double path_m) const {
    return config_.enabled && path_m - searched_m_ >= (KnowsThePlace(path_m) ? config_.every_known_m : config_.every_m);
  }
  // A former visit was recognised on the last kKnown_m: its key frames can be trusted here.
  bool KnowsThePlace(double path_m) const { return SinceLoop_m(path_m) < kKnown_m; }

  // Distance driven since a former visit was last recognised; infinite where none was.
  double SinceLoop_m(double path_m) const { return path_m - recognised_m_.value_or(-HUGE_VAL); }
  // Loops closed so far, without those that were left out again.
  int loops() const { return loops_ - joined_; }
  // Of all loops that agreed with the drift, in the graph or not (robust), and of the places that joined runs (not robust).
  const std::vector<GraphEdge>& edges() const { return edges_; }

  // Takes note that a former map was put before the key frames: its edges, the number of its key frames, and the place of
  // the newest key frame in it. keyframes: all, in the former map's frame.
  void Join(const std::vector<GraphEdge>& former, std::size_t former_keyframes, std::span<const Keyframe> keyframes,
            const Loop& place, double path_m);

 private:
  static constexpr double kKnown_m = 3.0;
  bool Agrees(const Loop& loop, const Pose& T_map_base);
  PoseGraph Graph(std::span<const Keyframe> keyframes) const;
  double DriftChi2(PoseGraph graph, const GraphEdge& edge, std::vector<Pose>& poses) const;

  LoopConfig config_;
  std::vector<GraphEdge> edges_;  // see edges()
  int loops_ = 0;                 // loops in the graph
  int joined_ = 0;                // of these: loops of the former map
  double searched_m_ = 0.0;
  std::optional<double> recognised_m_;
  std::optional<Pose> correction_;  // T_map_map of the last search
  int agreeing_ = 0;                // searches in a row that agree with it
};

}  // namespace merlin
