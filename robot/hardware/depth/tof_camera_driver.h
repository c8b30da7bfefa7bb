// The driver of the real ToF camera. A thread of its own calls the maker's library: it fetches frames, corrects their
// stamps, and reopens the camera when the connection is lost.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "robot/hal/clock.h"
#include "robot/hal/depth_camera.h"
#include "robot/hardware/depth/pmd_camera.h"
#include "robot/hardware/mailbox.h"

namespace merlin {

struct TofCameraConfig {
  PmdCameraConfig pmd;
  double electrons_per_amplitude = 1.0;  // of the library's unit; from the noise on a wall; 1 for the emulation
  double grey_per_intensity = 1.0;       // per unit of the library's intensity; 255 is the full well, more is clamped
  double silent_after_s = 0.5;           // without a frame the camera counts as silent
  double reopen_s = 0.5;                 // between attempts to open a lost camera; the first is made at once
};

template <class Visitor>
void Visit(Visitor& v, TofCameraConfig& c) {
  v("pmd", c.pmd);
  v("electrons_per_amplitude", c.electrons_per_amplitude, {1e-6, 1e6});
  v("grey_per_intensity", c.grey_per_intensity, {1e-6, 1e6});
  v("silent_after_s", c.silent_after_s, {0.01, 60.0});
  v("reopen_s", c.reopen_s, {0.01, 60.0});
}

class TofCameraDriver final : public DepthCamera {
 public:
  // Opens the library and the camera. Throws InputError for a file that is not a library or lacks calls, for a picture
  // that does not fit the sheet, and for invalid settings; MachineError if the camera cannot be opened. The clock's
  // Now() is also called from another thread.
  TofCameraDriver(const TofCameraConfig& config, const DepthCameraInfo& info, const DepthSettings& settings,
                  const Clock& clock);
  ~TofCameraDriver() override;

  const DepthCameraInfo& Info() const override { return info_; }
  // There are no calls for the maker's post-processing and raw data that all cameras share, so both are refused.
  void Configure(const DepthSettings& settings) override;
  std::optional<DepthFrame> Poll() override { return mailbox_.Take(); }
  DeviceStatus Status() const override { return WithRate(mailbox_.Status(clock_.Now()), info_.rate_hz); }
  std::string Complaint() const;  // why the last call of the library failed; empty if a frame came since

 private:
  void CheckAll(const DepthSettings& settings) const;
  void Run(std::stop_token stop);
  void OpenIfClosed();
  void SetIfNew();
  void Deliver(const PmdFrame& raw, Time arrival);
  void Lose(DeviceStatus::Health health, const std::string& complaint, std::stop_token stop);

  TofCameraConfig config_;
  DepthCameraInfo info_;
  const Clock& clock_;
  Mailbox<DepthFrame> mailbox_;

  mutable std::mutex mutex_;  // guards the next three
  std::string complaint_;
  DepthSettings wanted_;
  bool wanted_is_new_ = true;
  std::condition_variable_any stopping_;

  // Used by the thread only.
  std::unique_ptr<PmdCamera> camera_;
  bool open_ = false;
  bool was_lost_ = false;
  bool lost_once_ = false;  // and no frame has come since
  DepthSettings asked_;
  Time last_stamp_ = Time::min();
  std::uint64_t index_ = 0;
  std::jthread thread_;  // last: it ends before what it uses is destroyed
};

}  // namespace merlin
