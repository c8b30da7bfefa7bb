// The main loop, the same for the twin, a recording and the real car: wait for the tick, poll, perceive, locate, decide, drive.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "autonomy/arbitrate.h"
#include "autonomy/energy.h"
#include "autonomy/pilot.h"
#include "perception/pipeline.h"
#include "robot/base/first_fault.h"
#include "robot/hal/hal.h"
#include "slam/slam.h"

namespace merlin {

enum class LoopEnd { kTaskDone, kTimeUp, kInterrupted, kDeviceLost, kBatteryEmpty, kQuit, kCarLost };

// An operator's hand, asked at every tick.
using Hand = std::function<ManualCommand(Time now)>;

// What an operator wants to know.
struct HandStatus {
  Arbitration arbitration;
  ManualCommand wish;
  double speed_m_s = 0.0;  // of the rear axle's middle, by encoder and steering
  DriveState state;        // the last one
  EnergyLevel energy = EnergyLevel::kEnough;
  std::string doing;  // the pilot, if it drives
};

// What a run may look at from outside, each called in the loop's thread. Any may be empty.
struct LoopObserver {
  std::function<void(const DepthFrame&)> depth;
  std::function<void(const ColorFrame&)> color;
  std::function<void(Time now, const Decision&)> tick;      // after every decision
  std::function<void(Time now, const HandStatus&)> hand{};  // at every tick that has a hand
  std::function<bool()> car_lost{};  // asked at every tick: true ends the run (the truth knows, see car_watch.h)
};

class DriveLoop {
 public:
  DriveLoop(const Robot& robot, const CarDescription& car, const PerceptionConfig& perception, const SlamConfig& slam,
            const Task& task, const PilotConfig& pilot);

  // Until the task is done, the clock ends, stop is set, the battery is empty (autonomy/energy.h), the depth camera or
  // the drive is silent for a second, or the observer says that the car is lost. Then brakes, and waits until the car
  // stands, as far as the clock permits. The same where something throws: the first exception leaves this function once
  // the car stands. What a device throws, of whatever type, leaves it as a DeviceError that names the device.
  // With a hand the pilot only advises the arbiter (autonomy/arbitrate.h), its task has no end, and an empty battery
  // stops the pilot alone: the operator may bring the car home.
  LoopEnd Run(const std::atomic<bool>& stop, const LoopObserver& observer, const Hand& hand = {});

  const Slam& slam() const { return slam_; }
  const Energy& energy() const { return energy_; }
  const char* silent_device() const { return last_depth_ < last_drive_ ? "depth camera" : "drive"; }  // of kDeviceLost
  const std::vector<double>& stack_ms() const { return stack_ms_; }  // one a depth frame: filter to decision

 private:
  void Listen(const LoopObserver& observer);
  // On the next depth frame, if there is one.
  std::optional<Decision> Decide(const LoopObserver& observer, bool forget);
  bool Tick(const LoopObserver& observer);                          // true: the task is done
  bool TickByHand(const LoopObserver& observer, const Hand& hand);  // true: the operator quits
  std::optional<DriveCommand> Advice(Time now) const;
  LoopEnd Drive(const std::atomic<bool>& stop, const LoopObserver& observer, const Hand& hand);
  void Send(DriveCommand command);
  void Stand(FirstFault& faults);
  void AdaptExposure(const DepthFrame& frame);

  Robot robot_;
  IntegrationConfig integration_;
  Duration period_;
  Pipeline pipeline_;
  Slam slam_;
  Pilot pilot_;
  Energy energy_;
  Arbiter arbiter_;
  std::optional<Observation> seen_;  // the newest
  std::optional<Decision> advice_;   // the pilot's newest, ...
  Time advised_{0};                  // ... and when it came
  HandStatus status_;
  CarDescription car_;
  Time last_depth_{0}, last_drive_{0};
  std::vector<double> stack_ms_;
};

}  // namespace merlin
