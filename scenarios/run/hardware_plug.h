// The real car: the devices that a hardware file names, in real time. Nobody knows the truth.
#pragma once

#include <memory>

#include "robot/hardware/hardware_robot.h"
#include "scenarios/run/run.h"

namespace merlin {

// Waits until every device of the robot has delivered. Throws MachineError, a sentence for each that has not after ten
// seconds.
void RequireReady(HardwareRobot& robot);

// Throws InputError for a task that needs a turntable: a car on the floor has none.
void RequireNoTurntable(const Scenario& scenario);

// Opens options.hardware_file's devices, waits until all of them deliver, and checks that the car is fit to drive
// (scenarios/run/preflight.h). Throws InputError or MachineError, a line for each fault; nothing has moved then.
std::unique_ptr<Plug> MakeHardwarePlug(const RunOptions& options);

}  // namespace merlin
