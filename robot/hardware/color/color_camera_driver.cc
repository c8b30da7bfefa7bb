#include "robot/hardware/color/color_camera_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <utility>
#include <vector>

#include "robot/base/error.h"

namespace merlin {
namespace {

// The path of a V4L2 device; none: a stream.
std::optional<std::string> Device(const std::string& source) {
  if (!source.empty() && std::ranges::all_of(source, [](char c) { return c >= '0' && c <= '9'; }))
    return "/dev/video" + source;
  if (source.starts_with("/dev/")) return source;
  return std::nullopt;
}

int Milliseconds(double seconds) { return static_cast<int>(std::lround(1e3 * seconds)); }

// FFmpeg would write to the terminal when a stream ends, which a library must not do. A value that is already set
// stays.
void KeepFfmpegQuiet() { ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0); }

}  // namespace

ColorCameraDriver::ColorCameraDriver(const ColorCameraConfig& config, const ColorCameraInfo& info,
                                     const ColorSettings& settings, const Clock& clock)
    : config_(config),
      info_(info),
      clock_(clock),
      mailbox_(1, FromSeconds(config.silent_after_s), clock.Now()),
      wanted_(settings),
      source_device_(Device(config.source)),
      capture_(std::make_unique<cv::VideoCapture>()) {
  CheckSettings(info_.sheet, settings);
  if (!IsDevice()) KeepFfmpegQuiet();
  OpenIfClosed();
  thread_ = std::jthread([this](std::stop_token stop) { Run(stop); });
}

ColorCameraDriver::~ColorCameraDriver() = default;

void ColorCameraDriver::Configure(const ColorSettings& settings) {
  CheckSettings(info_.sheet, settings);
  const std::lock_guard lock(mutex_);
  wanted_ = settings;
  wanted_is_new_ = true;
}

void ColorCameraDriver::Run(std::stop_token stop) {
  cv::Mat picture;
  while (!stop.stop_requested()) {
    try {
      OpenIfClosed();
      SetIfNew();
      const bool grabbed = capture_->grab();
      const Time arrival = clock_.Now();
      if (!grabbed || !capture_->retrieve(picture)) throw MachineError(config_.source + ": gives no picture");
      Deliver(picture, arrival);
    } catch (const InputError&) {  // the camera works, but not as its sheet says
      Lose(DeviceStatus::Health::kFaulty, stop);
    } catch (const std::exception&) {  // MachineError, or OpenCV's own
      // A camera that is open but gives no picture is silent, which the mailbox notices. One that is not open is
      // absent.
      Lose(capture_->isOpened() ? DeviceStatus::Health::kOk : DeviceStatus::Health::kAbsent, stop);
    }
  }
}

void ColorCameraDriver::OpenIfClosed() {
  if (capture_->isOpened()) return;
  const CameraModel& camera = info_.sheet.camera;
  const bool open =
      IsDevice() ? capture_->open(*source_device_, cv::CAP_V4L2,
                                  {cv::CAP_PROP_FRAME_WIDTH, camera.width, cv::CAP_PROP_FRAME_HEIGHT, camera.height})
                 : capture_->open(config_.source, cv::CAP_FFMPEG,
                                  {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, Milliseconds(config_.open_limit_s),
                                   cv::CAP_PROP_READ_TIMEOUT_MSEC, Milliseconds(config_.read_limit_s)});
  if (!open) throw MachineError(config_.source + ": cannot be opened as a camera or a stream");
  if (IsDevice()) {
    capture_->set(cv::CAP_PROP_FPS, info_.rate_hz);
    capture_->set(cv::CAP_PROP_BUFFERSIZE, 1);  // always the newest picture, not one that has waited
  }
  CheckSize(static_cast<int>(capture_->get(cv::CAP_PROP_FRAME_WIDTH)),
            static_cast<int>(capture_->get(cv::CAP_PROP_FRAME_HEIGHT)));
  if (was_lost_) mailbox_.Become(DeviceStatus::Health::kSilent, clock_.Now());  // until its first picture
  const std::lock_guard lock(mutex_);
  wanted_is_new_ = true;
}

void ColorCameraDriver::CheckSize(int width, int height) const {
  const CameraModel& camera = info_.sheet.camera;
  if (width == camera.width && height == camera.height) return;
  throw InputError(config_.source, "the camera's picture does not fit the sheet " + info_.sheet.name,
                   fmt::format("{} x {} pixels", camera.width, camera.height), fmt::format("{} x {}", width, height));
}

void ColorCameraDriver::SetIfNew() {
  {
    const std::lock_guard lock(mutex_);
    if (!wanted_is_new_) return;
    asked_ = wanted_;
    wanted_is_new_ = false;
  }
  if (!IsDevice()) return;
  // V4L2_EXPOSURE_APERTURE_PRIORITY and V4L2_EXPOSURE_MANUAL; exposures in units of 100 us.
  capture_->set(cv::CAP_PROP_AUTO_EXPOSURE, asked_.auto_exposure ? 3 : 1);
  if (!asked_.auto_exposure) capture_->set(cv::CAP_PROP_EXPOSURE, asked_.exposure_s * 1e4);
}

void ColorCameraDriver::Deliver(const cv::Mat& picture, Time arrival) {
  CheckSize(picture.cols, picture.rows);
  if (picture.type() != CV_8UC3 || !picture.isContinuous())
    throw InputError(config_.source, "the pictures are not 8-bit BGR");
  const Time exposed = arrival - FromSeconds(info_.sheet.latency_s + config_.stream_latency_s);
  ColorFrame frame{.stamp = std::max(exposed, last_stamp_ + Duration(1)),
                   .index = index_++,
                   .settings = asked_,
                   .width = picture.cols,
                   .height = picture.rows,
                   .bgr = {picture.datastart, picture.dataend}};
  last_stamp_ = frame.stamp;
  mailbox_.Put(std::move(frame), arrival);
  lost_once_ = false;
}

void ColorCameraDriver::Lose(DeviceStatus::Health health, std::stop_token stop) {
  capture_->release();
  was_lost_ = true;
  if (health == DeviceStatus::Health::kFaulty) mailbox_.CountGarbage();
  if (health != DeviceStatus::Health::kOk) mailbox_.Become(health, clock_.Now());
  if (!std::exchange(lost_once_, true)) return;  // the first attempt is made at once: the fault may have been brief
  std::unique_lock lock(mutex_);
  stopping_.wait_for(lock, stop, FromSeconds(config_.reopen_s), [] { return false; });
}

}  // namespace merlin
