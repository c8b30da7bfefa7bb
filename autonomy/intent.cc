#include "autonomy/intent.h"

namespace merlin {

const char* Sentence(Activity activity) {
  switch (activity) {
    case Activity::kFollowsCorridor:
      return "follows the corridor";
    case Activity::kTurnsLeft:
      return "turns left";
    case Activity::kTurnsRight:
      return "turns right";
    case Activity::kFollowsPath:
      return "follows its path";
    case Activity::kTurnsOnTurntable:
      return "turns on its turntable";
    case Activity::kBacks:
      return "backs";
    case Activity::kIsDone:
      return "is done";
    case Activity::kWaitsForHeading:
      return "waits for its heading";
    case Activity::kIsLost:
      return "stands: it does not know where it is";
    case Activity::kWaitsForObstacle:
      return "waits for an obstacle";
    case Activity::kWaitsForFreeGround:
      return "stands: it knows no free ground behind it";
    case Activity::kSeesTooLittle:
      return "stands: it sees too little to begin a map";
  }
  return "";
}

}  // namespace merlin
