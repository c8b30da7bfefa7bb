// The colour driver and the emulated network camera, joined by a stream on this machine.
#include "robot/hardware/color/color_camera_driver.h"

#include <gtest/gtest.h>

#include "robot/base/error.h"
#include "robot/emulated/mjpeg_server.h"
#include "tests/support/until.h"

namespace merlin {
namespace {

using Health = DeviceStatus::Health;

constexpr int kColorWidth = 64, kColorHeight = 48;
constexpr double kStrictOrder_s = 1e-3;  // stamps of one arrival are a nanosecond apart

ColorCameraInfo ColorInfo() {
  ColorCameraInfo info;
  info.sheet.name = "small";
  info.sheet.camera = {.width = kColorWidth, .height = kColorHeight};
  info.sheet.latency_s = 0.050;
  info.sheet.exposure_nominal_s = 0.016;
  info.sheet.exposure_min_s = 1e-4;
  info.sheet.exposure_max_s = 0.033;
  info.sheet.gain_max = 8.0;
  info.rate_hz = 10.0;
  return info;
}

// Smooth, so that a JPEG keeps it: blue rises to the right, green downwards; red tells pictures apart.
ColorFrame Picture(int red, int width = kColorWidth, int height = kColorHeight) {
  ColorFrame frame;
  frame.width = width, frame.height = height;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (const int value : {3 * u, 4 * v, red}) frame.bgr.push_back(static_cast<std::uint8_t>(value));
  return frame;
}

// A camera that runs until this ends.
class Publisher {
 public:
  Publisher(MjpegServer& server, ColorFrame picture)
      : thread_([&server, picture](std::stop_token stop) {
          // As fast as the others take it: the driver must keep up with any rate.
          while (!stop.stop_requested()) server.Publish(picture), std::this_thread::yield();
        }) {}

 private:
  std::jthread thread_;
};

ColorCameraConfig CaptureConfig(const std::string& url) { return {.source = url, .reopen_s = 0.01}; }

std::optional<ColorFrame> Next(ColorCameraDriver& camera) {
  std::optional<ColorFrame> frame;
  EXPECT_TRUE(Until([&] { return (frame = camera.Poll()).has_value(); }));
  return frame;
}

double LargestDifference(const ColorFrame& a, const ColorFrame& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.bgr.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a.bgr[i]) - b.bgr[i]));
  return largest;
}

TEST(ColorCameraDriver, ShowsThePictureThatTheTwinPublished) {
  MjpegServer server;
  const ColorFrame sent = Picture(100);
  const Publisher publisher(server, sent);
  HandClock clock;
  const ColorSettings settings = DefaultSettings(ColorInfo().sheet);
  ColorCameraDriver camera(CaptureConfig(server.url()), ColorInfo(), settings, clock);
  const auto first = Next(camera), second = Next(camera);
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->bgr.size(), sent.bgr.size());
  EXPECT_LE(LargestDifference(*first, sent), 12.0);  // what quality 95 loses on ramps, colour at half resolution
  EXPECT_EQ(first->settings, settings);
  EXPECT_NEAR(Seconds(clock.Now() - first->stamp), 0.050, kStrictOrder_s);
  EXPECT_GT(second->stamp, first->stamp);
  EXPECT_EQ(camera.Status().health, Health::kOk);
}

TEST(ColorCameraDriver, SubtractsTheStreamsLatencyToo) {
  MjpegServer server;
  const Publisher publisher(server, Picture(0));
  HandClock clock;
  ColorCameraConfig config = CaptureConfig(server.url());
  config.stream_latency_s = 0.25;
  ColorCameraDriver camera(config, ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
  EXPECT_NEAR(Seconds(clock.Now() - Next(camera)->stamp), 0.300, kStrictOrder_s);
}

TEST(ColorCameraDriver, RefusesAStreamOfAnotherSize) {
  MjpegServer server;
  const Publisher publisher(server, Picture(0, 80, 60));
  HandClock clock;
  try {
    const ColorCameraDriver camera(CaptureConfig(server.url()), ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(
        std::string(error.what()),
        server.url() + ": the camera's picture does not fit the sheet small; expected 64 x 48 pixels, got 80 x 60");
  }
}

TEST(ColorCameraDriver, SaysThatNobodyIsThere) {
  HandClock clock;
  const std::string url = [] { return MjpegServer().url(); }();  // gone again
  for (const std::string& source : {url, std::string("/dev/no_such_camera"), std::string("99"), std::string("")}) {
    try {
      const ColorCameraDriver camera(CaptureConfig(source), ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
      FAIL() << source;
    } catch (const MachineError& error) {
      EXPECT_EQ(std::string(error.what()), source + ": cannot be opened as a camera or a stream");
    }
  }
}

TEST(ColorCameraDriver, ComesBackWhenTheStreamDoes) {
  auto server = std::make_unique<MjpegServer>();
  const std::string url = server->url();
  const int port = server->port();
  HandClock clock;
  std::optional<Publisher> publisher(std::in_place, *server, Picture(50));
  ColorCameraDriver camera(CaptureConfig(url), ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
  ASSERT_TRUE(Next(camera));
  publisher.reset();
  server.reset();
  EXPECT_TRUE(Until([&] { return camera.Status().health == Health::kAbsent; }));
  while (camera.Poll()) {
  }
  server = std::make_unique<MjpegServer>(port);
  publisher.emplace(*server, Picture(150));
  const auto frame = Next(camera);
  ASSERT_TRUE(frame.has_value());
  EXPECT_LE(LargestDifference(*frame, Picture(150)), 12.0);
  EXPECT_EQ(camera.Status().health, Health::kOk);
}

TEST(ColorCameraDriver, IsFaultyWhenTheSizeChanges) {
  auto server = std::make_unique<MjpegServer>();
  const std::string url = server->url();
  const int port = server->port();
  HandClock clock;
  std::optional<Publisher> publisher(std::in_place, *server, Picture(50));
  ColorCameraDriver camera(CaptureConfig(url), ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
  publisher.reset();
  server.reset();
  server = std::make_unique<MjpegServer>(port);
  publisher.emplace(*server, Picture(50, 80, 60));
  EXPECT_TRUE(Until([&] { return camera.Status().health == Health::kFaulty; }));
  EXPECT_TRUE(Until([&] { return camera.Status().garbage > 0; }));
}

TEST(ColorCameraDriver, ReopensAStreamThatStoppedSilently) {
  MjpegServer server;
  HandClock clock;
  std::optional<Publisher> publisher(std::in_place, server, Picture(50));
  ColorCameraConfig config = CaptureConfig(server.url());
  config.open_limit_s = config.read_limit_s = 0.2;
  ColorCameraDriver camera(config, ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
  ASSERT_TRUE(Next(camera));
  publisher.reset();  // the connection stays: nothing is said any more
  EXPECT_TRUE(Until([&] { return camera.Status().health == Health::kAbsent; }));
  publisher.emplace(server, Picture(50));
  while (camera.Poll()) {
  }
  EXPECT_TRUE(Next(camera));
}

TEST(ColorCameraDriver, RefusesSettingsOutsideTheSheetAndReportsThoseInForce) {
  MjpegServer server;
  const Publisher publisher(server, Picture(50));
  HandClock clock;
  ColorCameraDriver camera(CaptureConfig(server.url()), ColorInfo(), DefaultSettings(ColorInfo().sheet), clock);
  EXPECT_THROW(camera.Configure({.exposure_s = 1.0}), InputError);
  const ColorSettings settings{.exposure_s = 0.001, .auto_exposure = false};
  camera.Configure(settings);
  EXPECT_TRUE(Until([&] {
    const auto frame = camera.Poll();
    return frame && frame->settings == settings;
  }));
}

TEST(MjpegServer, SaysThatAPortIsTaken) {
  const MjpegServer first;
  EXPECT_THROW(MjpegServer second(first.port()), MachineError);
}

}  // namespace
}  // namespace merlin
