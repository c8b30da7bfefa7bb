// The driver of the real colour camera: a V4L2 device or a network stream, read through OpenCV. A thread of its own
// keeps the newest picture for the stack, and reopens a source that is lost.
//
// Measured: a 640 x 480 picture that the emulation's MjpegServer publishes is there for Poll 7 ms later (median; 95 %
// within 11 ms; two busy cores). FFmpeg's nobuffer and low_delay change nothing for MJPEG, where each picture stands
// for itself. For a stream whose pictures depend on each other (H.264), set OpenCV's OPENCV_FFMPEG_CAPTURE_OPTIONS.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "robot/hal/clock.h"
#include "robot/hal/color_camera.h"
#include "robot/hardware/mailbox.h"

namespace cv {
class Mat;
class VideoCapture;
}  // namespace cv

namespace merlin {

struct ColorCameraConfig {
  std::string source = "/dev/video0";  // a V4L2 device, its path or number; or a URL that FFmpeg opens
  double stream_latency_s = 0.0;       // of coding and network, added to the sheet's latency; 0.006 for the emulation
  double silent_after_s = 1.0;         // without a picture the camera counts as silent
  double reopen_s = 0.5;               // between attempts to open a lost source; the first is made at once
  double open_limit_s = 5.0;           // of a stream: opening fails if there is no answer by then
  double read_limit_s = 1.0;  // of a stream: it is reopened if no picture comes by then; a V4L2 device: 10 s (OpenCV's)
};

template <class Visitor>
void Visit(Visitor& v, ColorCameraConfig& c) {
  v("source", c.source);
  v("stream_latency_s", c.stream_latency_s, {0.0, 10.0});
  v("silent_after_s", c.silent_after_s, {0.01, 60.0});
  v("reopen_s", c.reopen_s, {0.01, 60.0});
  v("open_limit_s", c.open_limit_s, {0.1, 60.0});
  v("read_limit_s", c.read_limit_s, {0.1, 60.0});
}

class ColorCameraDriver final : public ColorCamera {
 public:
  // Opens the source, without waiting for a picture. Throws MachineError if it cannot be opened, InputError if it
  // reports another size than the sheet's, and for invalid settings. The clock's Now() is also called from another
  // thread.
  ColorCameraDriver(const ColorCameraConfig& config, const ColorCameraInfo& info, const ColorSettings& settings,
                    const Clock& clock);
  ~ColorCameraDriver() override;

  const ColorCameraInfo& Info() const override { return info_; }
  // A V4L2 device gets the exposure time or automatic exposure. Gain and white balance are not sent, because such
  // devices share no unit for them, and a stream takes no settings at all. The frames then report the settings that
  // were asked for.
  void Configure(const ColorSettings& settings) override;
  std::optional<ColorFrame> Poll() override { return mailbox_.Take(); }
  DeviceStatus Status() const override { return WithRate(mailbox_.Status(clock_.Now()), info_.rate_hz); }

 private:
  void Run(std::stop_token stop);
  void OpenIfClosed();
  void CheckSize(int width, int height) const;
  void SetIfNew();
  void Deliver(const cv::Mat& picture, Time arrival);
  void Lose(DeviceStatus::Health health, std::stop_token stop);
  bool IsDevice() const { return source_device_.has_value(); }

  ColorCameraConfig config_;
  ColorCameraInfo info_;
  const Clock& clock_;
  Mailbox<ColorFrame> mailbox_;

  std::mutex mutex_;  // guards the next two
  ColorSettings wanted_;
  bool wanted_is_new_ = true;
  std::condition_variable_any stopping_;

  // Used by the thread only.
  std::optional<std::string> source_device_;  // the path, if the source is a V4L2 device
  std::unique_ptr<cv::VideoCapture> capture_;
  bool was_lost_ = false;
  bool lost_once_ = false;  // and no picture has come since
  ColorSettings asked_;
  Time last_stamp_ = Time::min();
  std::uint64_t index_ = 0;
  std::jthread thread_;  // last: it ends before what it uses is destroyed
};

}  // namespace merlin
