// Simultaneous localisation and mapping, as one sentence: each frame is localised in the map, added to it where its
// pose can be trusted, and recorded on the trajectory (slam/localizer.h, slam/mapper.h). Key frames and closed loops
// follow F. Lu and E. Milios, "Globally consistent range scan alignment for environment mapping", Autonomous Robots 4,
// 1997.
//
//   in   Observation     points, wheel odometry and heading of one depth frame (perception/observation.h)
//   out  T_map_base      the car's pose at the frame's stamp
//        maps            local map, occupancy grid, whole map
//        trajectory      one pose a frame
#pragma once

#include <optional>
#include <vector>

#include "perception/observation.h"
#include "robot/types/footprint.h"
#include "slam/keyframe.h"
#include "slam/localizer.h"
#include "slam/mapper.h"
#include "slam/place_search.h"
#include "slam/saved_map.h"
#include "slam/slam_config.h"

namespace merlin {

struct MapPose {
  Time stamp{0};
  Pose T_map_base = Pose::Identity();
};

class Slam {
 public:
  // footprint: the car's. Where it drove nothing can still be in the map; an empty one clears nothing.
  // former: a map of an earlier run to start in. The car begins with a map of its own and searches for its place in the
  // former one (slam/place_search.h). Once it is found, the two are one map, in the frame of the former.
  explicit Slam(const SlamConfig& config, const Footprint& footprint = {}, std::optional<SavedMap> former = {});

  // The pose at the observation's stamp. Nothing while mapping waits for the heading to settle at the start, and for an
  // odometry that is not finite. Map frame: see slam/localizer.h.
  std::optional<Pose> Update(const Observation& observation);

  // To be called when a run has ended: searches for loops once more (slam/mapper.h). Corrects key frames, trajectory and
  // what is built from them.
  void Finish() { mapper_.Finish(); }

  const RegisterResult& last() const { return localizer_.last(); }  // how well the last frame fitted
  // Frames in a row that did not fit: odometry carried the pose, and nothing of them entered the map.
  int lost_frames() const { return localizer_.lost_frames(); }
  // Registration takes back, or adds, a good share of the distance that the wheels reported last.
  bool slipping() const { return localizer_.slipping(); }
  double path_m() const { return localizer_.path_m(); }  // distance driven

  // What became of the former map that was given.
  enum class Search { kNone, kSearching, kGaveUp, kFound };
  Search search() const { return search_state_; }
  // What it took so far, or until it was found or given up.
  struct SearchEffort {
    double time_s = 0.0, path_m = 0.0;
  };
  const SearchEffort& search_effort() const { return effort_; }
  // The map frame changed with the last frame, because the place was found; nothing: it is the same as before.
  const std::optional<Pose>& T_map_before() const { return T_map_before_; }

  const VoxelMap& local_map() const { return mapper_.local_map(); }
  // A closed loop corrects poses, key frames and the local map at once. The grid follows later, so that no frame takes
  // long: former key frames stay where they were for up to 40 frames (KeyframeGrid::kFrames; 2 s at 20 Hz), and for up
  // to 80 where the next loop is closed meanwhile. New key frames are in it at once.
  const OccupancyGrid& occupancy() const { return mapper_.occupancy(); }
  const std::vector<Keyframe>& keyframes() const { return mapper_.keyframes(); }
  int loops() const { return mapper_.loops(); }  // closed so far

  const std::vector<MapPose>& online() const { return online_; }  // one pose a frame, as the car drove by it
  std::vector<MapPose> trajectory() const;                        // the same frames, as the closed loops correct them

  // The whole map, from all key frames, coloured; what moved away is left out. Use its voxels with at least
  // map_points_min points.
  VoxelMap BuildMap() const { return mapper_.BuildMap(); }
  // All that is needed to go on with this map in another run.
  SavedMap Saved() const { return {keyframes(), mapper_.loop_edges(), localizer_.heading_turn_rad()}; }
  // The whole grid, from all key frames as the closed loops correct them.
  OccupancyGrid BuildOccupancy() const { return mapper_.BuildOccupancy(); }

 private:
  // A frame's pose from the newest key frame there was; from the map where there was none.
  struct Step {
    std::optional<std::size_t> keyframe;
    Pose T_keyframe_base;
  };

  void Record(Time stamp, const Pose& T_map_base);
  Pose SearchPlace(const Observation& observation, const Pose& T_map_base, bool trusted);
  void Join(const Loop& place, const Pose& T_map_base);

  SlamConfig config_;
  Localizer localizer_;
  Mapper mapper_;
  Search search_state_ = Search::kNone;
  std::optional<PlaceSearch> place_search_;  // only while it searches
  SearchEffort effort_;
  std::optional<Time> first_stamp_;
  std::optional<Pose> T_map_before_;
  std::vector<MapPose> online_;
  std::vector<Step> steps_;  // of the online poses
};

}  // namespace merlin
