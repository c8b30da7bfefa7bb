// What a behaviour wants the car to do. The pilot turns it into a command, and drives slower or not at all where that is
// not safe.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace merlin {

// What the car is doing, for programs. People read the sentence beside it.
enum class Activity {
  // Said by behaviours:
  kFollowsCorridor,
  kTurnsLeft,
  kTurnsRight,
  kFollowsPath,
  kTurnsOnTurntable,
  kBacks,
  kIsDone,
  // Said by the pilot, when it does not let the car drive:
  kWaitsForHeading,     // SLAM waits until the compass has settled
  kIsLost,              // too many frames in a row did not fit the map
  kWaitsForObstacle,    // something ahead is too near
  kWaitsForFreeGround,  // the map does not know the ground behind the car to be free
  kSeesTooLittle,       // no frame had points enough to begin a map
};

// "follows the corridor", "turns left", ...: the usual sentence, of which the car is the subject.
const char* Sentence(Activity activity);

enum class Direction { kForwards, kBackwards };

struct Intent {
  // Positions that the origin of the base frame is to pass, in the map frame and in driving order, at most 10 cm apart.
  // The part that is already behind is skipped. The car comes to a halt at the end of the path.
  std::vector<Eigen::Vector2d> path_map{};
  double steering_rad = 0.0;  // without a path: the angle that the wheels are to hold, positive to the left
  Direction direction = Direction::kForwards;
  double speed_m_s = 0.0;  // wished, not negative, whatever the direction; 0: stand still
  bool done = false;       // the task is finished
  Activity activity = Activity::kIsDone;
  std::string doing{};  // the same for people, in one sentence without "the car"; empty: the usual sentence
  std::optional<double>
      turntable_rad{};  // where the turntable below the car is to turn, from its start; none: as before
};

}  // namespace merlin
