#include "robot/hardware/depth/tof_camera_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr std::size_t kPlaces = 4;  // frames that wait for a slow reader

// The device counts whole microseconds and hertz. Settings that it confirms are therefore replaced by the exact ones
// that were asked for.
DepthSettings Used(const DepthSettings& told, const DepthSettings& asked) {
  DepthSettings used = told;
  if (std::lround(told.integration_s * 1e6) == std::lround(asked.integration_s * 1e6))
    used.integration_s = asked.integration_s;
  // The description's values for exposures that are not used have no meaning.
  if (asked.second_frequency_hz == 0.0) used.second_frequency_hz = 0.0;
  return used;
}

std::uint8_t Grey(double intensity) { return static_cast<std::uint8_t>(std::clamp(std::round(intensity), 0.0, 255.0)); }

// For a library without flags: the flags that follow from the images.
std::uint8_t FlagsOf(float range_m, float amplitude_e, const DepthCameraSheet& sheet) {
  if (range_m == 0.0f) return kInvalid;
  return amplitude_e < sheet.low_signal_amplitude_e ? kLowSignal : 0;
}

}  // namespace

TofCameraDriver::TofCameraDriver(const TofCameraConfig& config, const DepthCameraInfo& info,
                                 const DepthSettings& settings, const Clock& clock)
    : config_(config),
      info_(info),
      clock_(clock),
      mailbox_(kPlaces, FromSeconds(config.silent_after_s), clock.Now()),
      wanted_(settings),
      camera_(LoadPmdCamera(config.pmd, info.sheet)) {
  CheckAll(settings);
  OpenIfClosed();
  SetIfNew();
  thread_ = std::jthread([this](std::stop_token stop) { Run(stop); });
}

TofCameraDriver::~TofCameraDriver() = default;

void TofCameraDriver::CheckAll(const DepthSettings& settings) const {
  CheckSettings(info_.sheet, settings);
  if (settings.post_processing || settings.phase_images)
    throw InputError(info_.sheet.name, "the driver gives neither the maker's post-processing nor phase images");
  if (settings.second_frequency_hz > 0.0 && config_.pmd.generation == 1)
    throw InputError(info_.sheet.name, "a library of generation 1 measures with one frequency");
}

void TofCameraDriver::Configure(const DepthSettings& settings) {
  CheckAll(settings);
  const std::lock_guard lock(mutex_);
  wanted_ = settings;
  wanted_is_new_ = true;
}

std::string TofCameraDriver::Complaint() const {
  const std::lock_guard lock(mutex_);
  return complaint_;
}

void TofCameraDriver::Run(std::stop_token stop) {
  while (!stop.stop_requested()) {
    try {
      OpenIfClosed();
      SetIfNew();
      const PmdFrame frame = camera_->WaitForFrame();
      Deliver(frame, clock_.Now());
    } catch (const InputError& error) {  // the camera works, but not as its sheet says
      Lose(DeviceStatus::Health::kFaulty, error.what(), stop);
    } catch (const std::exception& error) {
      // A camera that is open but gives no frame is silent, which the mailbox notices. One that is not open is absent.
      Lose(open_ ? DeviceStatus::Health::kOk : DeviceStatus::Health::kAbsent, error.what(), stop);
    }
  }
}

void TofCameraDriver::OpenIfClosed() {
  if (open_) return;
  camera_->Open();
  open_ = true;
  if (was_lost_) mailbox_.Become(DeviceStatus::Health::kSilent, clock_.Now());  // until its first frame
  const std::lock_guard lock(mutex_);
  wanted_is_new_ = true;
}

void TofCameraDriver::SetIfNew() {
  {
    const std::lock_guard lock(mutex_);
    if (!wanted_is_new_) return;
    asked_ = wanted_;
    wanted_is_new_ = false;
  }
  camera_->Set(asked_);
}

void TofCameraDriver::Deliver(const PmdFrame& raw, Time arrival) {
  const CameraModel& camera = info_.sheet.camera;
  const std::size_t pixels = raw.range_m.size();
  DepthFrame frame{.stamp = std::max(arrival - FromSeconds(info_.sheet.latency_s), last_stamp_ + Duration(1)),
                   .index = index_++,
                   .settings = Used(raw.settings, asked_),
                   .width = camera.width,
                   .height = camera.height,
                   .range_m = raw.range_m,
                   .amplitude = std::vector<float>(pixels),
                   .intensity = std::vector<std::uint8_t>(pixels),
                   .flags = std::vector<std::uint8_t>(pixels),
                   .phase_images = {}};
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool finite = std::isfinite(raw.range_m[i]) && raw.range_m[i] >= 0.0f && std::isfinite(raw.amplitude[i]) &&
                        std::isfinite(raw.intensity[i]);
    if (!finite) {
      frame.range_m[i] = 0.0f;
      frame.flags[i] = kInvalid;
      continue;
    }
    frame.amplitude[i] = static_cast<float>(raw.amplitude[i] * config_.electrons_per_amplitude);
    frame.intensity[i] = Grey(raw.intensity[i] * config_.grey_per_intensity);
    frame.flags[i] = raw.flags.empty() ? FlagsOf(raw.range_m[i], frame.amplitude[i], info_.sheet)
                                       : static_cast<std::uint8_t>(raw.flags[i]);
  }
  last_stamp_ = frame.stamp;
  mailbox_.Put(std::move(frame), arrival);
  lost_once_ = false;
  const std::lock_guard lock(mutex_);
  complaint_.clear();
}

void TofCameraDriver::Lose(DeviceStatus::Health health, const std::string& complaint, std::stop_token stop) {
  camera_->Close();
  {
    const std::lock_guard lock(mutex_);
    complaint_ = complaint;
  }
  open_ = false;
  was_lost_ = true;
  if (health == DeviceStatus::Health::kFaulty) mailbox_.CountGarbage();
  if (health != DeviceStatus::Health::kOk) mailbox_.Become(health, clock_.Now());
  if (!std::exchange(lost_once_, true)) return;  // the first attempt is made at once: the fault may have been brief
  std::unique_lock lock(mutex_);
  stopping_.wait_for(lock, stop, FromSeconds(config_.reopen_s), [] { return false; });
}

}  // namespace merlin
