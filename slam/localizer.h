// Where the car is in the map: the pose of each frame. Wheel odometry and heading give a guess. Registration against
// the local map corrects it (slam/register/icp.h). A frame that does not fit is lost: odometry carries the pose, and
// the frame must not enter the map.
//
//   frame  origin and axes
//   map    where mapping began; axes along the world's as the compass has them. Without a compass: along the car's then
//   odom   where wheel odometry began; drifts
//   base   the car now: x forward, y left, z up
#pragma once

#include <cmath>
#include <optional>

#include "perception/observation.h"
#include "slam/map/voxel_map.h"
#include "slam/register/icp.h"
#include "slam/slam_config.h"

namespace merlin {

struct Localization {
  Pose T_map_base = Pose::Identity();
  bool trusted = false;  // true: the frame may enter the map
};

class Localizer {
 public:
  explicit Localizer(const SlamConfig& config) : config_(config) {}

  // False while mapping still waits for the heading to settle at the start. To be called before each Localize.
  bool Begin(const Observation& observation);
  // local_map: what the frame is registered against. has_map: false before the first key frame; such a frame is trusted
  // where it has points enough to be found again.
  Localization Localize(const Observation& observation, const VoxelMap& local_map, bool has_map);
  // Closed loops have moved the newest frame.
  void Correct(const Pose& T_map_base) { T_map_last_ = T_map_base; }

  // The map frame is another one from now on. heading_turn_rad: yaw in it less the compass's; nothing: not known.
  void ChangeMap(const Pose& T_new_map, std::optional<double> heading_turn_rad);
  // Yaw in the map less the compass's; nothing before the first heading.
  std::optional<double> heading_turn_rad() const { return map_turn_rad_; }

  // The observation's heading, in the map; nothing without a compass.
  std::optional<double> MapYaw_rad(const Observation& observation) const;
  const RegisterResult& last() const { return last_; }
  int lost_frames() const { return lost_frames_; }  // in a row
  bool slipping() const { return std::abs(slip_) > config_.slip_min; }
  double path_m() const { return path_m_; }  // distance driven since mapping began

 private:
  PosePrior Guess(const Observation& observation, const Pose& motion) const;
  void MeasureSlip(const Pose& motion, const Pose& T_guess_registered);
  bool SeesNewGround(const Observation& observation, std::size_t points) const;
  bool GivesUp(Time stamp, bool moves);

  SlamConfig config_;
  std::optional<Time> first_stamp_;
  std::optional<Pose> T_map_last_;  // the newest frame's pose, as corrected
  Pose T_odom_last_ = Pose::Identity();
  std::optional<double> map_turn_rad_;  // yaw in the map less the heading's
  RegisterResult last_;
  int lost_frames_ = 0;
  std::optional<Time> lost_at_rest_;  // since then
  double slip_ = 0.0;                 // share of the wheels' distance that registration adds, averaged
  double path_m_ = 0.0;
  double fitted_at_m_ = 0.0;  // path_m_ when a frame last fitted the map
};

}  // namespace merlin
