#include "scenarios/run/drive_loop.h"

#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "robot/base/error.h"
#include "robot/kinematics/ackermann.h"
#include "robot/kinematics/motion.h"
#include "slam/register/undetermined.h"

namespace merlin {
namespace {

constexpr Duration kHaltValid = std::chrono::seconds(1);
constexpr Duration kHaltLimit = std::chrono::seconds(3);

Rig RigOf(const Robot& robot, const CarDescription& car) {
  const DepthCameraInfo& depth = robot.depth->Info();
  Rig rig{.car = car, .depth = depth.sheet, .T_base_depth = depth.T_base_camera, .color = std::nullopt};
  if (robot.color != nullptr) {
    rig.color = robot.color->Info().sheet;
    rig.T_base_color = robot.color->Info().T_base_camera;
  }
  rig.pans = robot.pan != nullptr && car.pan;
  rig.on_turntable = robot.turntable != nullptr;
  return rig;
}

}  // namespace

DriveLoop::DriveLoop(const Robot& robot, const CarDescription& car, const PerceptionConfig& perception,
                     const SlamConfig& slam, const Task& task, const PilotConfig& pilot, std::optional<SavedMap> former)
    : robot_(robot),
      exposure_(robot.depth->Info().sheet, robot.depth->Info().rate_hz, perception.integration),
      period_(FromSeconds(1.0 / robot.depth->Info().rate_hz)),
      pipeline_(RigOf(robot, car), perception),
      slam_(slam, FootprintOf(car), std::move(former)),
      pilot_(car, task, pilot),
      energy_(car, pilot.energy),
      arbiter_(car, pilot.avoid, pilot.arbitrate),
      car_(car) {}

void DriveLoop::Tick(const ManualInput& manual) {
  state_.now = robot_.clock->Now();
  Listen();
  for (const auto& frame : state_.heard.depth) Decide(*frame);
  Supervise();
  Arbitrate(manual);
  Act();
}

void DriveLoop::Listen() {
  state_.heard = {};
  ears_->Hear(state_.heard);
  for (const DriveState& state : state_.heard.drive) Follow(state);
  for (const PanState& state : state_.heard.pan) pipeline_.AddPan(state);
  for (const PanState& state : state_.heard.turntable) pipeline_.AddTurntable(state);
  for (const CompassReading& reading : state_.heard.compass) pipeline_.Add(reading);
  for (const auto& frame : state_.heard.color) pipeline_.Add(frame);
}

void DriveLoop::Follow(const DriveState& state) {
  pipeline_.Add(state);
  energy_.Update(state);
  const DriveState& before = state_.drive;
  if (before.stamp > Time(0) && state.stamp > before.stamp)
    state_.speed_m_s =
        Path_m(car_, state.encoder_counts - before.encoder_counts, WheelsAngle_rad(car_, state.steering_rad)) /
        Seconds(state.stamp - before.stamp);
  state_.drive = state;
}

void DriveLoop::Decide(const DepthFrame& frame) {
  const auto begin = std::chrono::steady_clock::now();
  ChooseExposure(frame);
  auto observation = pipeline_.Process(frame);
  if (!observation) return;
  state_.T_map_base = slam_.Update(*observation);
  const Driver before = state_.arbitration.driver;
  Decision decision = pilot_.Decide({.now = state_.now,
                                     .observation = *observation,
                                     .T_map_base = state_.T_map_base,
                                     .local_map = slam_.local_map(),
                                     .grid = slam_.occupancy(),
                                     .lost_frames = slam_.lost_frames(),
                                     .has_map = !slam_.keyframes().empty(),
                                     .holds_position = slam_.last().level_share >= kHeldShareMin,
                                     .searching = slam_.search() == Slam::Search::kSearching,
                                     .T_map_before = slam_.T_map_before(),
                                     .taken_over = before == Driver::kManual || before == Driver::kObstacleStop});
  if (energy_.level() == EnergyLevel::kLow) decision.doing += "; battery low";
  stack_ms_.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  state_.observation = std::make_shared<const Observation>(*std::move(observation));
  state_.decision = std::move(decision);
  state_.decided = state_.now;
  state_.path_m = slam_.path_m();
  state_.loops = slam_.loops();
}

void DriveLoop::Supervise() {
  state_.devices = ears_->devices();
  supervisor_.Watch(state_.now, state_.devices);
  state_.stop = supervisor_.stop();
  state_.outages = supervisor_.outages();
  state_.energy = energy_.level();
}

// The pilot's command while it is still valid. A tick without a new frame does not extend its validity.
std::optional<DriveCommand> DriveLoop::Advice() const {
  if (!state_.decision || state_.energy == EnergyLevel::kEmpty) return std::nullopt;
  DriveCommand command = state_.decision->command;
  command.valid_for -= state_.now - state_.decided;
  return command.valid_for > Duration(0) ? std::optional(command) : std::nullopt;
}

void DriveLoop::Arbitrate(const ManualInput& manual) {
  state_.manual = manual ? manual(state_.now) : ManualCommand{.heard = state_.now, .autonomy = true};
  state_.arbitration = arbiter_.Decide(state_.now, state_.manual, Advice(), state_.observation.get());
}

void DriveLoop::Act() {
  Send(state_.arbitration.command);
  if (robot_.pan != nullptr && state_.decided == state_.now && state_.decision->pan_rad)
    UseDevice("pan unit", [this] { robot_.pan->Send(*state_.decision->pan_rad); });
  if (robot_.turntable == nullptr || state_.decided != state_.now || !state_.decision->turntable_rad) return;
  UseDevice("turntable", [this] { robot_.turntable->Send(*state_.decision->turntable_rad); });
}

void DriveLoop::ChooseExposure(const DepthFrame& frame) {
  const DepthSettings next = exposure_.After(frame);
  if (next.integration_s == integration_s_.value_or(frame.settings.integration_s)) return;
  integration_s_ = next.integration_s;
  UseDevice("depth camera", [&] { robot_.depth->Configure(next); });
}

// Commands of the stack hold the angle of the wheels; the servo expects the angle that it will report. This is the only
// place that converts between them.
void DriveLoop::Send(DriveCommand command) {
  command.steering_rad = ServoAngle_rad(car_, command.steering_rad);
  UseDevice("drive", [&] { robot_.drive->Send(command); });
}

// Brakes and waits until the car stands. A device that throws does not keep the others from being used.
void DriveLoop::Halt(FirstFault& faults) {
  const Time begin = robot_.clock->Now();
  std::optional<DriveState> before;
  while (robot_.clock->Now() - begin < kHaltLimit) {
    faults.Try([&] { Send({.speed_m_s = 0.0, .steering_rad = 0.0, .valid_for = kHaltValid}); });
    // A lost drive reports no speed to wait for; its microcontroller brakes by itself.
    if (robot_.drive->Status().health == DeviceStatus::Health::kAbsent) return;
    bool goes_on = false;
    faults.Try([&] { goes_on = robot_.clock->WaitUntil(robot_.clock->Now() + period_); });
    if (!goes_on) return;
    std::optional<DriveState> state;
    faults.Try([&] {
      while (auto next = UseDevice("drive", [this] { return robot_.drive->Poll(); })) state = next;
    });
    if (state && before && state->encoder_counts == before->encoder_counts) return;
    if (state) before = state;
  }
}

LoopEnd DriveLoop::Drive(const std::atomic<bool>& stop, const LoopObserver& observer, const ManualInput& manual) {
  state_.began = robot_.clock->Now();
  ears_.emplace(robot_);
  for (Time tick = robot_.clock->Now() + period_; robot_.clock->WaitUntil(tick); tick += period_) {
    Tick(manual);
    if (observer && !observer(state_)) return LoopEnd::kEndedFromOutside;
    if (state_.manual.quit) return LoopEnd::kQuit;
    if (!manual && state_.decision && state_.decision->done) return LoopEnd::kTaskDone;
    if (stop.load()) return LoopEnd::kInterrupted;
    if (!manual && state_.decision && !state_.decision->gives_up.empty()) return LoopEnd::kGivesUp;
    if (!manual && state_.energy == EnergyLevel::kEmpty) return LoopEnd::kBatteryEmpty;
    if (!manual && slam_.search() == Slam::Search::kGaveUp) return LoopEnd::kPlaceUnknown;
    if (!state_.stop.empty()) return LoopEnd::kDeviceLost;
  }
  return LoopEnd::kTimeUp;
}

LoopEnd DriveLoop::Run(const std::atomic<bool>& stop, const LoopObserver& observer, const ManualInput& manual) {
  FirstFault faults;
  LoopEnd end = LoopEnd::kTimeUp;
  faults.Try([&] { end = Drive(stop, observer, manual); });
  Halt(faults);
  faults.Try([&] { slam_.Finish(); });
  if (faults.get()) std::rethrow_exception(faults.get());
  return end;
}

}  // namespace merlin
