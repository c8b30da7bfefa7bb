// The main loop, the same for the twin, a recording and the real car, with and without an operator: wait for the tick,
// listen, perceive, locate, decide, supervise, arbitrate, drive.
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

// What an operator wants, asked at every tick.
using ManualInput = std::function<ManualCommand(Time now)>;

// Called after every tick, in the loop's thread. False ends the run: somebody outside knows that the car is lost.
using LoopObserver = std::function<bool(const LoopState&)>;

class DriveLoop {
 public:
  // former: the map of an earlier run to start in.
  DriveLoop(const Robot& robot, const CarDescription& car, const PerceptionConfig& perception, const SlamConfig& slam,
            const Task& task, const PilotConfig& pilot, std::optional<SavedMap> former = {});

  // Until the task is done, the clock ends, stop is set, the battery is empty (autonomy/energy.h), the car does not get on
  // (autonomy/unstick.h), a device without which the car must not drive has failed (autonomy/supervise.h), the car gives up
  // the search for its place in the former map, or the observer ends it. Then brakes, and waits until the car stands, as far
  // as the clock permits. The same where something throws: the first exception leaves this function once the car stands.
  // What a device throws, of whatever type, leaves it as a DeviceError that names the device.
  // With an operator the pilot only advises the arbiter (autonomy/arbitrate.h), its task has no end, it does not give up,
  // and an empty battery stops the pilot alone: the operator may bring the car home.
  LoopEnd Run(const std::atomic<bool>& stop, const LoopObserver& observer, const ManualInput& manual = {});

  const LoopState& state() const { return state_; }  // of the last tick
  const Slam& slam() const { return slam_; }
  const Energy& energy() const { return energy_; }
  const std::vector<double>& stack_ms() const { return stack_ms_; }  // one a depth frame: filter to decision

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
  std::optional<double> integration_s_;  // as last asked for; nothing: as the camera was set up
  Duration period_;
  Pipeline pipeline_;
  Slam slam_;
  Pilot pilot_;
  Energy energy_;
  Arbiter arbiter_;
  Supervisor supervisor_;
  std::optional<Ears> ears_;  // since Run began
  LoopState state_;
  CarDescription car_;
  std::vector<double> stack_ms_;
};

}  // namespace merlin
