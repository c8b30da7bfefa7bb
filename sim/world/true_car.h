// The car as it truly is: its description, with the differences that the scenario wants the stack not to know.
#pragma once

#include "robot/types/car.h"
#include "robot/types/drivetrain_config.h"

namespace merlin::sim {

// The description with all wheels' collision radii scaled by wheel_radius_factor (their centres stay, so that the body
// sits higher or lower) and the front axle moved so that the wheelbase is wheelbase_factor times the described one. What
// is seen of the wheels stays: half a percent does not show.
CarDescription TrueCar(CarDescription car, const DrivetrainConfig& config);

}  // namespace merlin::sim
