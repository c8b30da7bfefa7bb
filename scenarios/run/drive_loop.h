// The main loop: wait for the tick, poll devices, perceive, localise, decide, supervise, arbitrate, drive. It is the
// same for the twin, a recording and the real car, with and without an operator.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "autonomy/arbitrate.h"
#include "autonomy/energy.h"
#include "autonomy/pilot.h"
#include "autonomy/supervise.h"
#include "perception/exposure_control.h"
#include "perception/pipeline.h"
#include "robot/base/first_fault.h"
#include "robot/hal/hal.h"
#include "scenarios/run/hear.h"
#include "scenarios/run/loop_state.h"
#include "slam/slam.h"

namespace merlin {

enum class LoopEnd {
  kTaskDone,
  kTimeUp,
  kInterrupted,
  kDeviceLost,
  kBatteryEmpty,
  kPlaceUnknown,
  kQuit,
  kGivesUp,
  kEndedFromOutside
};

// Returns the operator's command. Called at every tick.
using ManualInput = std::function<ManualCommand(Time now)>;

// Called after every tick, in the loop's thread. Returns false to end the run, for example because the car is lost.
using LoopObserver = std::function<bool(const LoopState&)>;

class DriveLoop {
 public:
  // former: the map of an earlier run to start in.
  DriveLoop(const Robot& robot, const CarDescription& car, const PerceptionConfig& perception, const SlamConfig& slam,
            const Task& task, const PilotConfig& pilot, std::optional<SavedMap> former = {});

  // Runs until the task is done, the clock ends, stop is set, the battery is empty (autonomy/energy.h), the car makes
  // no progress (autonomy/unstick.h), a device that the car needs to drive has failed (autonomy/supervise.h), the car does
  // not find its place in the former map, or the observer ends it. Then brakes the car and waits until it stands, as far
  // as the clock permits. The same happens if something throws: the first exception leaves this function once the car
  // stands. Whatever a device throws becomes a DeviceError that names the device.
  // With an operator, the pilot only advises the arbiter (autonomy/arbitrate.h), its task never ends, and it does not
  // give up. An empty battery then stops only the pilot, so that the operator can drive the car home.
  LoopEnd Run(const std::atomic<bool>& stop, const LoopObserver& observer, const ManualInput& manual = {});

  const LoopState& state() const { return state_; }  // after the last tick
  const Slam& slam() const { return slam_; }
  const Energy& energy() const { return energy_; }
  const std::vector<double>& stack_ms() const { return stack_ms_; }  // per depth frame: time from filter to decision

 private:
  LoopEnd Drive(const std::atomic<bool>& stop, const LoopObserver& observer, const ManualInput& manual);
  void Tick(const ManualInput& manual);
  void Listen();
  void Follow(const DriveState& state);
  void Decide(const DepthFrame& frame);
  void Supervise();
  void Arbitrate(const ManualInput& manual);
  void Act();
  std::optional<DriveCommand> Advice() const;
  void ChooseExposure(const DepthFrame& frame);
  void Send(DriveCommand command);
  void Halt(FirstFault& faults);

  Robot robot_;
  ExposureControl exposure_;
  std::optional<double> integration_s_;  // last one requested; none: that of the camera's initial settings
  Duration period_;
  Pipeline pipeline_;
  Slam slam_;
  Pilot pilot_;
  Energy energy_;
  Arbiter arbiter_;
  Supervisor supervisor_;
  std::optional<Ears> ears_;  // set when Run begins
  LoopState state_;
  CarDescription car_;
  std::vector<double> stack_ms_;
};

}  // namespace merlin
