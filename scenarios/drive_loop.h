// The main loop, the same for the twin, a recording and the real car: wait for the tick, poll, perceive, locate, decide, drive.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "autonomy/pilot.h"
#include "perception/pipeline.h"
#include "robot/hal/hal.h"
#include "slam/slam.h"

namespace merlin {

enum class LoopEnd { kTaskDone, kTimeUp, kInterrupted, kDeviceLost, kBatteryEmpty };

// What a run may look at from outside, each called in the loop's thread. Any may be empty.
struct LoopObserver {
  std::function<void(const DepthFrame&)> depth;
  std::function<void(const ColorFrame&)> color;
  std::function<void(Time now, const Decision&)> tick;  // after every decision
};

class DriveLoop {
 public:
  DriveLoop(const Robot& robot, const CarDescription& car, const PerceptionConfig& perception, const SlamConfig& slam,
            const Task& task, const PilotConfig& pilot);

  // Until the task is done, the clock ends, stop is set, the battery is empty (autonomy/energy.h), or the depth camera or
  // the drive is silent for a second. Then, the clock permitting, brakes and waits until the car stands.
  LoopEnd Run(const std::atomic<bool>& stop, const LoopObserver& observer);

  const Slam& slam() const { return slam_; }
  const Energy& energy() const { return energy_; }
  const std::vector<double>& stack_ms() const { return stack_ms_; }  // one a depth frame: filter to decision

 private:
  bool Tick(const LoopObserver& observer);  // true: the task is done
  void Stand();
  void AdaptExposure(const DepthFrame& frame);

  Robot robot_;
  IntegrationConfig integration_;
  Duration period_;
  Pipeline pipeline_;
  Slam slam_;
  Pilot pilot_;
  Energy energy_;
  Time last_depth_{0}, last_drive_{0};
  std::vector<double> stack_ms_;
};

}  // namespace merlin
