// Searches for the car's place in the map of an earlier run, without any guess of where it is (slam/loop/find_place.h). A
// place counts as found where searches in a row, apart from each other, lead to the same one. A wrong place would have
// to fit each time, and to move by the distance that the car drove.
//
//   frame   origin and axes
//   former  those of the map that was loaded
//   map     those of this run, until the place is found
//   base    the car now
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "slam/loop/find_place.h"
#include "slam/saved_map.h"
#include "slam/slam_config.h"

namespace merlin {

class PlaceSearch {
 public:
  PlaceSearch(SavedMap former, const SlamConfig& config);

  // The car has moved on, or turned, far enough since the last search; at once before the first.
  bool IsDue(const Pose& T_map_base) const;
  // points_base: what was seen lately. yaw_rad: the heading by the compass, if there is one; it leaves out places that it
  // contradicts, where the former map has headings too. What is returned has T_former_base as its T_map_base, and a key
  // frame of the former map. Nothing: not found yet.
  std::optional<Loop> Search(std::span<const Point> points_base, const Pose& T_map_base, std::optional<double> yaw_rad);

  SavedMap Release() { return std::move(former_); }  // the former map, when the search is over

 private:
  SavedMap former_;
  SlamConfig config_;
  PlaceFinder finder_;
  std::optional<Pose> T_map_searched_;  // where the car was at the last search
  std::optional<Pose> T_former_map_;    // as the last search found it
  int agreeing_ = 0;                    // searches in a row that agree with it
};

}  // namespace merlin
