// The real car: the devices named by a hardware file, in real time. The truth is not known.
#pragma once

#include <memory>

#include "robot/hardware/hardware_robot.h"
#include "scenarios/run/run.h"

namespace merlin {

// Waits until every device of the robot has delivered data. Throws MachineError with one sentence for each device that
// has not after ten seconds.
void RequireReady(HardwareRobot& robot);

// Throws InputError for a task that needs a turntable, which only the twin has.
void RequireNoTurntable(const Scenario& scenario);

// Opens options.hardware_file's devices, waits until all of them deliver, and checks that the car is fit to drive
// (scenarios/run/preflight.h). Throws InputError or MachineError with one line per fault, before anything moves.
std::unique_ptr<Plug> MakeHardwarePlug(const RunOptions& options);

}  // namespace merlin
