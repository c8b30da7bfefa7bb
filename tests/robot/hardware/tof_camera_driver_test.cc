// The ToF driver and the emulated vendor library, joined by the very socket that a run uses.
#include "robot/hardware/depth/tof_camera_driver.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <random>

#include "robot/base/error.h"
#include "robot/emulated/depth_connection.h"
#include "robot/emulated/depth_server.h"
#include "robot/protocol/pmd_api.h"
#include "tests/support/until.h"

namespace merlin {
namespace {

using Health = DeviceStatus::Health;

constexpr int kWidth = 8, kHeight = 6;

DepthCameraInfo Info() {
  DepthCameraInfo info;
  info.sheet.name = "small";
  info.sheet.camera = {.width = kWidth, .height = kHeight, .fx_px = 8.0, .fy_px = 8.0, .cx_px = 3.5, .cy_px = 2.5};
  info.sheet.latency_s = 0.020;
  info.sheet.low_signal_amplitude_e = 600.0;
  info.sheet.integration_min_s = 100e-6;
  info.sheet.integration_max_s = 5e-3;
  info.sheet.frequencies_hz = {20e6, 30e6};
  info.rate_hz = 20.0;
  return info;
}

// Ranges with every bit in use, and what flags and amplitudes can be.
DepthFrame Frame(unsigned int seed) {
  std::mt19937 random(seed);
  DepthFrame frame;
  frame.width = kWidth, frame.height = kHeight;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    frame.range_m.push_back(static_cast<float>(random()) * 1.7e-9f);
    frame.amplitude.push_back(static_cast<float>(random()) * 1e-5f);
    frame.intensity.push_back(static_cast<std::uint8_t>(random()));
    frame.flags.push_back(static_cast<std::uint8_t>(random() % 32));
  }
  return frame;
}

// A path that no other test uses.
std::string SocketPath() {
  static int number = 0;
  return std::filesystem::temp_directory_path() /
         ("merlin_tof_" + std::to_string(::getpid()) + "_" + std::to_string(++number));
}

// The twin's side: publishes frames, and stores the settings that it receives.
struct Emulation {
  explicit Emulation(std::string at = SocketPath(), DepthCameraSheet sheet = Info().sheet)
      : path(std::move(at)), server(path, sheet, {}, [this](const DepthSettings& asked) {
          const std::lock_guard lock(mutex);
          settings = asked;
        }) {}
  DepthSettings Settings() {
    const std::lock_guard lock(mutex);
    return settings;
  }

  std::string path;
  std::mutex mutex;
  DepthSettings settings;
  DepthServer server;
};

TofCameraConfig Config(const std::string& path) {
  TofCameraConfig config;
  config.pmd.library = PMD_LIBRARY;
  config.pmd.source_argument = path;
  config.reopen_s = 0.01;
  return config;
}

// Publishes until the driver returns a frame; a frame that arrives while the driver is busy is lost.
std::optional<DepthFrame> Exchange(Emulation& emulation, TofCameraDriver& camera, const DepthFrame& frame) {
  std::optional<DepthFrame> got;
  EXPECT_TRUE(Until([&] {
    emulation.server.Publish(frame);
    return (got = camera.Poll()).has_value();
  }));
  return got;
}

std::string ErrorOf(const TofCameraConfig& config, const DepthCameraInfo& info = Info()) {
  const HandClock clock;
  try {
    const TofCameraDriver camera(config, info, {}, clock);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(TofCameraDriver, GivesBackTheVeryBitsThatTheTwinPublished) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  for (unsigned int seed = 1; seed <= 20; ++seed) {
    const DepthFrame sent = Frame(seed);
    while (camera.Poll()) {
    }
    std::optional<DepthFrame> got;
    do {  // the one before may still be on its way
      got = Exchange(emulation, camera, sent);
      ASSERT_TRUE(got.has_value());
    } while (got->range_m != sent.range_m);
    EXPECT_EQ(got->amplitude, sent.amplitude);
    EXPECT_EQ(got->intensity, sent.intensity);
    EXPECT_EQ(got->flags, sent.flags);
    EXPECT_EQ(got->width, kWidth);
    EXPECT_EQ(got->height, kHeight);
  }
  EXPECT_EQ(camera.Status().health, Health::kOk);
}

TEST(TofCameraDriver, StampsTheMiddleOfTheExposureInStrictOrder) {
  Emulation emulation;
  HandClock clock;  // stands still: arrivals cannot be told apart
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  const auto first = Exchange(emulation, camera, Frame(1)), second = Exchange(emulation, camera, Frame(2));
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(Seconds(clock.Now() - first->stamp), 0.020, 1e-3);
  EXPECT_GT(second->stamp, first->stamp);
  EXPECT_GT(second->index, first->index);
}

TEST(TofCameraDriver, SettingsReachTheTwinAndComeBackWithTheFrames) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  unsigned int seed = 1;
  // Both orders of the two frequencies: no step between may hold one of them twice.
  for (const DepthSettings& asked : {DepthSettings{123e-6, 30e6}, DepthSettings{5e-3, 20e6, 30e6},
                                     DepthSettings{5e-3, 30e6, 20e6}, DepthSettings{1e-3, 20e6}}) {
    camera.Configure(asked);
    const auto arrived = [&] {
      const DepthSettings got = emulation.Settings();
      return std::abs(got.integration_s - asked.integration_s) < 1e-9 && got.frequency_hz == asked.frequency_hz &&
             got.second_frequency_hz == asked.second_frequency_hz;
    };
    EXPECT_TRUE(Until([&] { return emulation.server.Publish(Frame(1)), arrived(); }));
    DepthFrame exposed = Frame(++seed);
    exposed.settings = asked;
    std::optional<DepthFrame> got;
    do {
      got = Exchange(emulation, camera, exposed);
    } while (got && got->range_m != exposed.range_m);
    ASSERT_TRUE(got.has_value());
    EXPECT_EQ(got->settings.integration_s, asked.integration_s);
    EXPECT_EQ(got->settings.frequency_hz, asked.frequency_hz);
    EXPECT_EQ(got->settings.second_frequency_hz, asked.second_frequency_hz);
  }
}

TEST(TofCameraDriver, RefusesSettingsThatTheSheetOrTheLibraryDoesNotHave) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  EXPECT_THROW(camera.Configure({1.0, 20e6}), InputError);
  EXPECT_THROW(camera.Configure({1e-3, 25e6}), InputError);
  EXPECT_THROW(camera.Configure({std::nan(""), 20e6}), InputError);
  EXPECT_THROW(camera.Configure({.phase_images = true}), InputError);
}

TEST(TofCameraDriver, RejectsPixelsThatAreNotFinite) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  DepthFrame sent = Frame(1);
  sent.range_m[0] = std::nanf("");
  sent.range_m[1] = -1.0f;
  sent.amplitude[2] = INFINITY;
  const auto got = Exchange(emulation, camera, sent);
  ASSERT_TRUE(got.has_value());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(got->range_m[i], 0.0f);
    EXPECT_EQ(got->flags[i], kInvalid);
  }
  EXPECT_EQ(got->range_m[3], sent.range_m[3]);
}

TEST(TofCameraDriver, KeepsTheNewestForASlowReaderAndCountsTheRest) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  EXPECT_TRUE(Until([&] { return emulation.server.Publish(Frame(1)), camera.Status().missed >= 10; }));
  std::uint64_t taken = 0;
  Time last = Time::min();
  while (const auto frame = camera.Poll()) {
    EXPECT_GT(frame->stamp, last);
    last = frame->stamp;
    ++taken;
  }
  EXPECT_GE(taken, 1u);
  EXPECT_EQ(camera.Status().delivered, taken);
}

TEST(TofCameraDriver, IsSilentWithoutFramesAndOkWithTheNext) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  ASSERT_TRUE(Exchange(emulation, camera, Frame(1)));
  EXPECT_EQ(camera.Status().health, Health::kOk);
  EXPECT_TRUE(Until([&] {  // a frame may still be on its way
    clock.WaitUntil(clock.Now() + std::chrono::seconds(2));
    return camera.Status().health == Health::kSilent;
  }));
  EXPECT_TRUE(Until([&] { return emulation.server.Publish(Frame(2)), camera.Status().health == Health::kOk; }));
}

TEST(TofCameraDriver, ComesBackWhenTheCameraDoesAndSetsItAgain) {
  const std::string path = SocketPath();
  HandClock clock;
  auto emulation = std::make_unique<Emulation>(path);
  TofCameraDriver camera(Config(path), Info(), {2e-3, 30e6}, clock);
  ASSERT_TRUE(Exchange(*emulation, camera, Frame(1)));
  emulation.reset();
  EXPECT_TRUE(Until([&] { return camera.Status().health == Health::kAbsent; }));
  while (camera.Poll()) {
  }
  emulation = std::make_unique<Emulation>(path);
  const auto got = Exchange(*emulation, camera, Frame(2));
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->range_m, Frame(2).range_m);
  EXPECT_EQ(camera.Status().health, Health::kOk);
  EXPECT_EQ(emulation->Settings().integration_s, 2e-3);
  EXPECT_EQ(emulation->Settings().frequency_hz, 30e6);
}

TEST(TofCameraDriver, IsFaultyWhenAnotherCameraComesBack) {
  const std::string path = SocketPath();
  HandClock clock;
  auto emulation = std::make_unique<Emulation>(path);
  TofCameraDriver camera(Config(path), Info(), {}, clock);
  emulation.reset();
  DepthCameraSheet other = Info().sheet;
  other.camera.width = kWidth + 1;
  emulation = std::make_unique<Emulation>(path, other);
  EXPECT_TRUE(Until([&] { return camera.Status().health == Health::kFaulty; }));
  EXPECT_TRUE(Until([&] { return camera.Status().garbage > 0; }));
}

TEST(TofCameraDriver, SaysWhatIsWrongWithTheLibrary) {
  TofCameraConfig config = Config("nowhere");
  config.pmd.library = "/no/such/library.so";
  EXPECT_EQ(ErrorOf(config), "/no/such/library.so: no such library");
  config.pmd.library = std::filesystem::temp_directory_path();
  EXPECT_EQ(ErrorOf(config), config.pmd.library + ": no such library");
  config.pmd.library = SocketPath();
  std::ofstream(config.pmd.library) << "no library\n";
  EXPECT_NE(ErrorOf(config).find(": cannot be opened as a shared library ("), std::string::npos) << ErrorOf(config);
  std::filesystem::remove(config.pmd.library);
  config.pmd.library = NO_PMD_LIBRARY;
  EXPECT_EQ(ErrorOf(config),
            config.pmd.library +
                ": the library lacks pmdSetIntegrationTime, pmdGetValidIntegrationTime, pmdSetModulationFrequency, "
                "pmdGetValidModulationFrequency, pmdGetDistances, pmdGetAmplitudes, pmdGetIntensities, pmdGetFlags, "
                "pmdGetSourceDataDescription");
  config.pmd.generation = 1;
  EXPECT_NE(ErrorOf(config).find("the library lacks pmdConnectFireWire, pmdSetIntegrationTime"), std::string::npos);
}

TEST(TofCameraDriver, SaysWhyTheCameraDoesNotOpen) {
  const HandClock clock;
  const std::string nowhere = SocketPath();
  EXPECT_THROW(TofCameraDriver(Config(nowhere), Info(), {}, clock), MachineError);
  EXPECT_EQ(ErrorOf(Config(nowhere)), std::string(PMD_LIBRARY) + ": pmdOpen failed: " + nowhere +
                                          ": no camera answers there: No such file or directory");
  EXPECT_NE(ErrorOf(Config(std::string(200, 'x'))).find("has 1 to 107 bytes, got 200"), std::string::npos);
  EXPECT_NE(ErrorOf(Config("")).find("has 1 to 107 bytes, got 0"), std::string::npos);
}

TEST(TofCameraDriver, IsSilentAndTellsWhyWhereTheLibraryThrows) {
  TofCameraConfig config = Config("");
  config.pmd.library = THROWING_PMD_LIBRARY;
  HandClock clock;
  ASSERT_EQ(::setenv("MERLIN_THROWING_PMD", "8x6x2", 1), 0);
  TofCameraDriver camera(config, Info(), {}, clock);
  int frames = 0;
  EXPECT_TRUE(Until([&] { return (frames += camera.Poll().has_value()) == 2 && !camera.Complaint().empty(); }));
  EXPECT_EQ(camera.Complaint(), std::string(THROWING_PMD_LIBRARY) + ": the library threw: the lamp has burnt out");
  EXPECT_TRUE(Until([&] {
    clock.WaitUntil(clock.Now() + std::chrono::seconds(2));
    return camera.Status().health == Health::kSilent;
  }));
  ASSERT_EQ(::setenv("MERLIN_THROWING_PMD", "8x6x1000", 1), 0);  // repaired
  EXPECT_TRUE(Until([&] { return camera.Poll() && camera.Complaint().empty(); }));
}

TEST(TofCameraDriver, RefusesACameraThatIsNotTheSheets) {
  Emulation emulation;
  DepthCameraInfo info = Info();
  info.sheet.camera.width = 64;
  EXPECT_EQ(ErrorOf(Config(emulation.path), info),
            std::string(PMD_LIBRARY) +
                ": the camera's picture does not fit the sheet small; expected 64 x 6 pixels, got 8 x 6");
}

TEST(TofCameraDriver, SpeaksTheOlderGenerationToo) {
  Emulation emulation;
  ASSERT_EQ(::setenv("MERLIN_PMD_SOCKET", emulation.path.c_str(), 1), 0);
  HandClock clock;
  TofCameraConfig config = Config("");
  config.pmd.library = PMD_LIBRARY_1;
  config.pmd.generation = 1;
  TofCameraDriver camera(config, Info(), {3e-3, 30e6}, clock);
  DepthFrame sent = Frame(1);
  sent.range_m[0] = 0.0f;
  sent.amplitude[1] = 599.0f;
  const auto got = Exchange(emulation, camera, sent);
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->range_m, sent.range_m);
  EXPECT_EQ(got->amplitude, sent.amplitude);
  EXPECT_EQ(got->intensity, sent.intensity);
  EXPECT_EQ(got->flags[0], kInvalid);  // no flags in this generation: what the images tell
  EXPECT_EQ(got->flags[1], kLowSignal);
  EXPECT_EQ(emulation.Settings().integration_s, 3e-3);
  EXPECT_EQ(emulation.Settings().frequency_hz, 30e6);
  EXPECT_EQ(got->settings.integration_s, 3e-3);
  EXPECT_THROW(camera.Configure({1e-3, 20e6, 30e6}), InputError);
}

TEST(DepthServer, DropsAClientThatSendsGarbageAndServesTheOthers) {
  Emulation emulation;
  HandClock clock;
  TofCameraDriver camera(Config(emulation.path), Info(), {}, clock);
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    const int socket = ConnectTo(emulation.path);
    std::vector<std::uint8_t> garbage(100);
    for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
    ::send(socket, garbage.data(), garbage.size(), MSG_NOSIGNAL);
    std::uint8_t byte;
    while (::recv(socket, &byte, 1, 0) > 0) {  // its hello; then it hangs up
    }
    ::close(socket);
  }
  EXPECT_TRUE(Exchange(emulation, camera, Frame(1)));
}

TEST(TofCameraDriver, SurvivesAServerThatSendsGarbage) {
  const std::string path = SocketPath();
  std::atomic<int> visits = 0;
  HandClock clock;
  auto emulation = std::make_unique<Emulation>(path);
  TofCameraDriver camera(Config(path), Info(), {}, clock);
  emulation.reset();
  {
    ConnectionServer garbage(ListenAt(path), [&](int socket) {
      const std::vector<std::uint8_t> bytes(1000, static_cast<std::uint8_t>(++visits));
      ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    });
    EXPECT_TRUE(Until([&] { return visits >= 5; }));
    EXPECT_TRUE(Until([&] { return camera.Status().health == Health::kAbsent; }));
  }
  emulation = std::make_unique<Emulation>(path);
  EXPECT_TRUE(Exchange(*emulation, camera, Frame(1)));
}

// The library's calls that the driver does not make.
struct VendorLibrary {
  VendorLibrary() : library(::dlopen(PMD_LIBRARY, RTLD_NOW | RTLD_LOCAL)) {}
  ~VendorLibrary() { ::dlclose(library); }
  template <class Function>
  Function* Call(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(library, name));
  }
  void* library;
};

TEST(PmdLibrary, FindsValidValuesAndGivesCoordinates) {
  Emulation emulation;
  VendorLibrary vendor;
  PmdHandle handle = 0;
  ASSERT_EQ(vendor.Call<PmdOpen>("pmdOpen")(&handle, "", emulation.path.c_str(), "", ""), kPmdOk);
  const auto valid_time = vendor.Call<PmdGetValidIntegrationTime>("pmdGetValidIntegrationTime");
  const auto valid_frequency = vendor.Call<PmdGetValidModulationFrequency>("pmdGetValidModulationFrequency");
  unsigned int valid = 0;
  EXPECT_EQ(valid_time(handle, &valid, 0, kPmdCloseTo, 9999), kPmdOk);
  EXPECT_EQ(valid, 5000u);
  EXPECT_NE(valid_time(handle, &valid, 0, kPmdAtLeast, 9999), kPmdOk);
  EXPECT_EQ(valid_frequency(handle, &valid, 0, kPmdAtLeast, 20000001), kPmdOk);
  EXPECT_EQ(valid, 30000000u);
  EXPECT_EQ(valid_frequency(handle, &valid, 0, kPmdAtMost, 29000000), kPmdOk);
  EXPECT_EQ(valid, 20000000u);
  EXPECT_EQ(valid_frequency(handle, &valid, 0, kPmdCloseTo, 26000000), kPmdOk);
  EXPECT_EQ(valid, 30000000u);

  std::vector<float> xyz(3 * kWidth * kHeight);
  const auto coordinates = vendor.Call<PmdGet3DCoordinates>("pmdGet3DCoordinates");
  EXPECT_NE(coordinates(handle, xyz.data(), xyz.size() * sizeof(float)), kPmdOk);  // before the first update
  const DepthFrame sent = Frame(1);
  EXPECT_TRUE(Until([&] {
    emulation.server.Publish(sent);
    return vendor.Call<PmdUpdate>("pmdUpdate")(handle) == kPmdOk;
  }));
  EXPECT_NE(coordinates(handle, xyz.data(), xyz.size() * sizeof(float) - 1), kPmdOk);  // memory too small
  ASSERT_EQ(coordinates(handle, xyz.data(), xyz.size() * sizeof(float)), kPmdOk);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const std::size_t i = static_cast<std::size_t>(v * kWidth + u);
      const Eigen::Vector3d point(xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
      EXPECT_NEAR(point.norm(), sent.range_m[i], 1e-5);
      EXPECT_NEAR(point.x() * 8.0, point.z() * (u - 3.5), 1e-4);
      EXPECT_NEAR(point.y() * 8.0, point.z() * (v - 2.5), 1e-4);
    }
  }
  std::size_t bytes = 0;
  EXPECT_NE(vendor.Call<PmdGetSourceDataSize>("pmdGetSourceDataSize")(handle, &bytes), kPmdOk);
  char text[8];
  EXPECT_EQ(vendor.Call<PmdGetLastError>("pmdGetLastError")(handle, text, sizeof text), kPmdOk);
  EXPECT_STREQ(text, "the emu");  // cut, and ended
  EXPECT_EQ(vendor.Call<PmdClose>("pmdClose")(handle), kPmdOk);
  EXPECT_NE(vendor.Call<PmdClose>("pmdClose")(handle), kPmdOk);
}

}  // namespace
}  // namespace merlin
