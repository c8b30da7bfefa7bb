#include "robot/emulated/depth_server.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "robot/base/error.h"
#include "robot/emulated/depth_connection.h"

namespace merlin {
namespace {

// How long an update waits for the next exposure before it fails.
constexpr std::chrono::milliseconds kFrameLimit(250);

std::uint32_t Whole(double value) { return static_cast<std::uint32_t>(std::llround(value)); }

WireSettings ToWire(const DepthSettings& settings) {
  return {Whole(settings.integration_s * 1e6), Whole(settings.frequency_hz), Whole(settings.second_frequency_hz)};
}

DepthSettings FromWire(const WireSettings& settings) {
  return {.integration_s = settings.integration_us / 1e6,  // the nearest double, as if written by hand
          .frequency_hz = static_cast<double>(settings.frequency_hz),
          .second_frequency_hz = static_cast<double>(settings.second_frequency_hz)};
}

}  // namespace

DepthServer::DepthServer(const std::string& path, const DepthCameraSheet& sheet, const DepthSettings& settings,
                         OnSettings on_settings)
    : path_(path),
      sheet_(sheet),
      on_settings_(std::move(on_settings)),
      settings_(ToWire(settings)),
      server_(ListenAt(path), [this](int socket) { Serve(socket); }) {}

DepthServer::~DepthServer() {
  frames_.Close();
  std::error_code error;
  std::filesystem::remove(path_, error);  // a new client finds no camera from here on
}

void DepthServer::Publish(const DepthFrame& frame) {
  frames_.Put({.columns = static_cast<std::uint16_t>(frame.width),
               .rows = static_cast<std::uint16_t>(frame.height),
               .stamp_ns = static_cast<std::uint64_t>(frame.stamp.count()),
               .settings = ToWire(frame.settings),
               .range_m = frame.range_m,
               .amplitude = frame.amplitude,
               .intensity = frame.intensity,
               .flags = frame.flags});
}

void DepthServer::Serve(int socket) {
  DepthConnection connection(socket);
  std::uint64_t seen = frames_.count();
  if (!connection.Send(Hello())) return;
  while (const std::optional<WireMessage> request = connection.Receive()) {
    const WireSet* const set = std::get_if<WireSet>(&*request);
    if (set == nullptr && !std::holds_alternative<WireUpdate>(*request)) return;
    if (!connection.Send(set != nullptr ? Set(set->settings) : NextFrame(seen))) return;
  }
}

WireMessage DepthServer::Hello() {
  const std::lock_guard lock(mutex_);
  WireHello hello{.camera = sheet_.camera,
                  .integration_min_us = Whole(sheet_.integration_min_s * 1e6),
                  .integration_max_us = Whole(sheet_.integration_max_s * 1e6),
                  .frequencies_hz = {},
                  .settings = settings_};
  for (const double frequency_hz : sheet_.frequencies_hz) hello.frequencies_hz.push_back(Whole(frequency_hz));
  return hello;
}

WireMessage DepthServer::NextFrame(std::uint64_t& seen) {
  const auto frame = frames_.WaitAfter(seen, kFrameLimit);
  if (frame.item == nullptr) return WireRefused{"the camera gives no frame"};
  seen = frame.number;
  return *frame.item;
}

WireMessage DepthServer::Set(const WireSettings& settings) {
  const std::lock_guard lock(mutex_);
  try {
    const DepthSettings asked = FromWire(settings);
    CheckSettings(sheet_, asked);
    on_settings_(asked);
  } catch (const InputError& error) {
    return WireRefused{error.what()};
  }
  settings_ = settings;
  return WireDone{};
}

}  // namespace merlin
