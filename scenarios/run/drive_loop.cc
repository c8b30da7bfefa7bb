#include "scenarios/run/drive_loop.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr Duration kSilent = std::chrono::seconds(1);
constexpr Duration kStandLimit = std::chrono::seconds(3);

Rig RigOf(const Robot& robot, const CarDescription& car) {
  const DepthCameraInfo& depth = robot.depth->Info();
  Rig rig{.car = car, .depth = depth.sheet, .T_base_depth = depth.T_base_camera, .color = std::nullopt};
  if (robot.color != nullptr) {
    rig.color = robot.color->Info().sheet;
    rig.T_base_color = robot.color->Info().T_base_camera;
  }
  rig.pans = robot.pan != nullptr && car.pan;
  rig.on_stand = robot.stand != nullptr;
  return rig;
}

// Uses a device. What its driver throws becomes a DeviceError that names the device.
template <class Use>
auto Ask(const std::string& device, const Use& use) {
  try {
    return use();
  } catch (const std::exception& error) {
    throw DeviceError(device + ": " + error.what());
  } catch (...) {
    throw DeviceError(device + ": its driver threw an unknown exception");
  }
}

// Of a device that may be absent.
template <class Device>
auto Poll(const std::string& name, Device* device) -> decltype(device->Poll()) {
  if (device == nullptr) return std::nullopt;
  return Ask(name, [device] { return device->Poll(); });
}

}  // namespace

DriveLoop::DriveLoop(const Robot& robot, const CarDescription& car, const PerceptionConfig& perception,
                     const SlamConfig& slam, const Task& task, const PilotConfig& pilot)
    : robot_(robot),
      integration_(perception.integration),
      period_(FromSeconds(1.0 / robot.depth->Info().rate_hz)),
      pipeline_(RigOf(robot, car), perception),
      slam_(slam, FootprintOf(car)),
      pilot_(car, task, pilot),
      energy_(car, pilot.energy),
      arbiter_(car, pilot.avoid, pilot.arbitrate),
      metres_per_count_(car.MetresPerCount()) {}

void DriveLoop::Listen(const LoopObserver& observer) {
  while (auto state = Poll("drive", robot_.drive)) {
    last_drive_ = robot_.clock->Now();
    pipeline_.Add(*state);
    energy_.Update(*state);
    const double counts = static_cast<double>(state->encoder_counts - status_.state.encoder_counts);
    if (status_.state.stamp > Time(0) && state->stamp > status_.state.stamp)
      status_.speed_m_s = counts * metres_per_count_ / Seconds(state->stamp - status_.state.stamp);
    status_.state = *state;
  }
  while (const auto state = Poll("pan unit", robot_.pan)) pipeline_.AddPan(*state);
  while (const auto state = Poll("stand", robot_.stand)) pipeline_.AddStand(*state);
  while (const auto reading = Poll("compass", robot_.compass)) pipeline_.Add(*reading);
  while (auto frame = Poll("colour camera", robot_.color)) {
    if (observer.color) observer.color(*frame);
    pipeline_.Add(std::move(*frame));
  }
}

std::optional<Decision> DriveLoop::Decide(const LoopObserver& observer, bool forget) {
  while (auto frame = Poll("depth camera", robot_.depth)) {
    last_depth_ = robot_.clock->Now();
    if (observer.depth) observer.depth(*frame);
    const auto begin = std::chrono::steady_clock::now();
    if (integration_.adapt) AdaptExposure(*frame);
    auto observation = pipeline_.Process(std::move(*frame));
    if (!observation) continue;
    const auto T_map_base = slam_.Update(*observation);
    if (forget) pilot_.Forget();
    Decision decision = pilot_.Decide(*observation, T_map_base, slam_);
    if (energy_.level() == EnergyLevel::kLow) decision.doing += "; battery low";
    stack_ms_.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    seen_ = std::move(observation);
    return decision;
  }
  return std::nullopt;
}

bool DriveLoop::Tick(const LoopObserver& observer) {
  Listen(observer);
  bool done = false;
  while (const auto decision = Decide(observer, false)) {
    Send(decision->command);
    if (robot_.stand != nullptr && decision->stand_rad) Ask("stand", [&] { robot_.stand->Send(*decision->stand_rad); });
    done = decision->done;
    if (observer.tick) observer.tick(robot_.clock->Now(), *decision);
  }
  return done;
}

// What the pilot would do, for as long as that holds: a tick without a frame does not prolong it.
std::optional<DriveCommand> DriveLoop::Advice(Time now) const {
  if (!advice_ || energy_.level() == EnergyLevel::kEmpty) return std::nullopt;
  DriveCommand command = advice_->command;
  command.valid_for -= now - advised_;
  return command.valid_for > Duration(0) ? std::optional(command) : std::nullopt;
}

bool DriveLoop::TickByHand(const LoopObserver& observer, const Hand& hand) {
  Listen(observer);
  const Time now = robot_.clock->Now();
  while (auto decision = Decide(observer, status_.arbitration.driver != Driver::kAutonomy))
    advice_ = std::move(decision), advised_ = now;
  status_.wish = hand(now);
  status_.energy = energy_.level();
  status_.arbitration = arbiter_.Decide(now, status_.wish, Advice(now), seen_ ? &*seen_ : nullptr);
  status_.doing = status_.arbitration.driver == Driver::kAutonomy ? advice_->doing : "";
  Send(status_.arbitration.command);
  if (observer.hand) observer.hand(now, status_);
  return status_.wish.quit;
}

void DriveLoop::AdaptExposure(const DepthFrame& frame) {
  const DepthCameraInfo& info = robot_.depth->Info();
  const DepthSettings adapted = Adapt(frame, info.sheet, info.rate_hz, integration_);
  if (adapted.integration_s != frame.settings.integration_s)
    Ask("depth camera", [&] { robot_.depth->Configure(adapted); });
}

void DriveLoop::Send(const DriveCommand& command) {
  Ask("drive", [&] { robot_.drive->Send(command); });
}

// Devices that throw now do not keep the others from being used.
void DriveLoop::Stand(FirstFault& faults) {
  const Time begin = robot_.clock->Now();
  std::optional<DriveState> before;
  while (robot_.clock->Now() - begin < kStandLimit) {
    faults.Try([&] { Send({.speed_m_s = 0.0, .steering_rad = 0.0, .valid_for = kSilent}); });
    // A drive that has gone tells nothing more: its microcontroller brakes by itself.
    if (robot_.drive->Status().health == DeviceStatus::Health::kAbsent) return;
    bool goes_on = false;
    faults.Try([&] { goes_on = robot_.clock->WaitUntil(robot_.clock->Now() + period_); });
    if (!goes_on) return;
    std::optional<DriveState> state;
    faults.Try([&] {
      while (auto next = Poll("drive", robot_.drive)) state = next;
    });
    if (state && before && state->encoder_counts == before->encoder_counts) return;
    if (state) before = state;
  }
}

LoopEnd DriveLoop::Drive(const std::atomic<bool>& stop, const LoopObserver& observer, const Hand& hand) {
  last_depth_ = last_drive_ = robot_.clock->Now();
  for (Time tick = robot_.clock->Now() + period_; robot_.clock->WaitUntil(tick); tick += period_) {
    const bool done = hand ? TickByHand(observer, hand) : Tick(observer);
    if (observer.car_lost && observer.car_lost()) return LoopEnd::kCarLost;
    if (done) return hand ? LoopEnd::kQuit : LoopEnd::kTaskDone;
    if (stop.load()) return LoopEnd::kInterrupted;
    if (!hand && energy_.level() == EnergyLevel::kEmpty) return LoopEnd::kBatteryEmpty;
    if (robot_.clock->Now() - std::min(last_depth_, last_drive_) > kSilent + period_) return LoopEnd::kDeviceLost;
  }
  return LoopEnd::kTimeUp;
}

LoopEnd DriveLoop::Run(const std::atomic<bool>& stop, const LoopObserver& observer, const Hand& hand) {
  FirstFault faults;
  LoopEnd end = LoopEnd::kTimeUp;
  faults.Try([&] { end = Drive(stop, observer, hand); });
  Stand(faults);
  if (faults.get()) std::rethrow_exception(faults.get());
  return end;
}

}  // namespace merlin
