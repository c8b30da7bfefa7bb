// The car as simulated: the description that the stack uses, plus deviations that the stack does not know.
#pragma once

#include "robot/types/car.h"
#include "robot/types/drivetrain_config.h"

namespace merlin::sim {

// Scales the collision radius of all wheels by wheel_radius_factor. The wheel centres stay where they are on the body,
// so the body rides higher or lower. Moves the front axle so that the wheelbase is scaled by wheelbase_factor. The
// visible wheels keep their size: half a percent cannot be seen.
CarDescription TrueCar(CarDescription car, const DrivetrainConfig& config);

}  // namespace merlin::sim
