#include "robot/hardware/depth/pmd_camera.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>
#include <utility>

#include "robot/base/error.h"
#include "robot/hardware/depth/shared_library.h"
#include "robot/protocol/pmd_api.h"

namespace merlin {
namespace {

unsigned int Rounded(double value) { return static_cast<unsigned int>(std::lround(value)); }

// What both generations share.
class Library {
 public:
  explicit Library(const std::string& path) : library_(path) {
    library_.Find("pmdClose", close_);
    library_.Find("pmdUpdate", update_);
    library_.Find("pmdGetLastError", last_error_);
  }

 protected:
  ~Library() { CloseHandle(); }
  void Check(int result, const char* call) const {
    if (result == kPmdOk) return;
    std::array<char, 1024> text{};
    const bool told = last_error_(handle_, text.data(), text.size()) == kPmdOk && text[0] != '\0';
    text.back() = '\0';
    throw MachineError(fmt::format("{}: {} failed: {}", library_.path(), call,
                                   told ? std::string(text.data()) : fmt::format("error {}", result)));
  }
  void CloseHandle() {
    const PmdHandle handle = std::exchange(handle_, 0);
    try {
      if (handle != 0) close_(handle);
    } catch (...) {  // the library cannot close: nothing more can be done
    }
  }
  void Update() { Check(update_(handle_), "pmdUpdate"); }

  SharedLibrary library_;
  PmdHandle handle_ = 0;

 private:
  PmdClose* close_;
  PmdUpdate* update_;
  PmdGetLastError* last_error_;
};

class Generation2 final : public PmdCamera, private Library {
 public:
  Generation2(const PmdCameraConfig& config, const DepthCameraSheet& sheet)
      : Library(config.library), config_(config), sheet_(sheet) {
    library_.Find("pmdOpen", open_);
    library_.Find("pmdSetIntegrationTime", set_integration_);
    library_.Find("pmdGetValidIntegrationTime", valid_integration_);
    library_.Find("pmdSetModulationFrequency", set_frequency_);
    library_.Find("pmdGetValidModulationFrequency", valid_frequency_);
    library_.Find("pmdGetDistances", distances_);
    library_.Find("pmdGetAmplitudes", amplitudes_);
    library_.Find("pmdGetIntensities", intensities_);
    library_.Find("pmdGetFlags", flags_);
    library_.Find("pmdGetSourceDataDescription", describe_);
    library_.RequireAll();
  }

  void Open() override {
    PmdHandle handle = 0;
    Check(open_(&handle, config_.source_plugin.c_str(), config_.source_argument.c_str(),
                config_.processing_plugin.c_str(), config_.processing_argument.c_str()),
          "pmdOpen");
    handle_ = handle;
    // Some cameras describe themselves only once they have a frame.
    PmdDescription description{};
    if (describe_(handle_, &description) != kPmdOk) Update();
    Describe();
  }
  void Close() override { CloseHandle(); }

  void Set(const DepthSettings& settings) override {
    unsigned int valid_us = 0;
    Check(valid_integration_(handle_, &valid_us, 0, kPmdCloseTo, Rounded(settings.integration_s * 1e6)),
          "pmdGetValidIntegrationTime");
    Check(set_integration_(handle_, 0, valid_us), "pmdSetIntegrationTime");
    // Set in steps, so that the two frequencies are never the same. A camera with one frequency is not asked for a
    // second index.
    if (second_frequency_set_) SetFrequency(1, 0.0);
    SetFrequency(0, settings.frequency_hz);
    second_frequency_set_ = settings.second_frequency_hz > 0.0;
    if (second_frequency_set_) SetFrequency(1, settings.second_frequency_hz);
  }

  PmdFrame WaitForFrame() override {
    Update();
    const PmdDescription description = Describe();
    const std::size_t pixels = static_cast<std::size_t>(description.columns) * description.rows;
    PmdFrame frame{.settings = {.integration_s = description.integration_us[0] * 1e-6,
                                .frequency_hz = static_cast<double>(description.frequency_hz[0]),
                                .second_frequency_hz = static_cast<double>(description.frequency_hz[1])},
                   .range_m = std::vector<float>(pixels),
                   .amplitude = std::vector<float>(pixels),
                   .intensity = std::vector<float>(pixels),
                   .flags = std::vector<unsigned int>(pixels)};
    Check(distances_(handle_, frame.range_m.data(), pixels * sizeof(float)), "pmdGetDistances");
    Check(amplitudes_(handle_, frame.amplitude.data(), pixels * sizeof(float)), "pmdGetAmplitudes");
    Check(intensities_(handle_, frame.intensity.data(), pixels * sizeof(float)), "pmdGetIntensities");
    Check(flags_(handle_, frame.flags.data(), pixels * sizeof(unsigned int)), "pmdGetFlags");
    return frame;
  }

 private:
  PmdDescription Describe() const {
    PmdDescription description{};
    Check(describe_(handle_, &description), "pmdGetSourceDataDescription");
    const CameraModel& camera = sheet_.camera;
    if (description.columns != static_cast<unsigned int>(camera.width) ||
        description.rows != static_cast<unsigned int>(camera.height))
      throw InputError(library_.path(), "the camera's picture does not fit the sheet " + sheet_.name,
                       fmt::format("{} x {} pixels", camera.width, camera.height),
                       fmt::format("{} x {}", description.columns, description.rows));
    return description;
  }
  void SetFrequency(unsigned int index, double frequency_hz) {
    unsigned int valid_hz = 0;
    if (frequency_hz > 0.0)
      Check(valid_frequency_(handle_, &valid_hz, index, kPmdCloseTo, Rounded(frequency_hz)),
            "pmdGetValidModulationFrequency");
    Check(set_frequency_(handle_, index, valid_hz), "pmdSetModulationFrequency");
  }

  PmdCameraConfig config_;
  DepthCameraSheet sheet_;
  bool second_frequency_set_ = false;
  PmdOpen* open_;
  PmdSetIntegrationTime* set_integration_;
  PmdGetValidIntegrationTime* valid_integration_;
  PmdSetModulationFrequency* set_frequency_;
  PmdGetValidModulationFrequency* valid_frequency_;
  PmdGetDistances* distances_;
  PmdGetAmplitudes* amplitudes_;
  PmdGetIntensities* intensities_;
  PmdGetFlags* flags_;
  PmdGetSourceDataDescription* describe_;
};

// These calls do not tell the picture's size, so the sheet must have the right one.
class Generation1 final : public PmdCamera, private Library {
 public:
  Generation1(const PmdCameraConfig& config, const DepthCameraSheet& sheet)
      : Library(config.library),
        name_(sheet.name),
        pixels_(static_cast<std::size_t>(sheet.camera.width) * static_cast<std::size_t>(sheet.camera.height)) {
    library_.Find("pmdConnectFireWire", connect_);
    library_.Find("pmdSetIntegrationTime", set_integration_);
    library_.Find("pmdSetModulationFrequency", set_frequency_);
    library_.Find("pmdGetDistances", distances_);
    library_.Find("pmdGetAmplitudes", amplitudes_);
    library_.Find("pmdGetIntensities", intensities_);
    library_.RequireAll();
  }

  void Open() override {
    PmdHandle handle = 0;
    Check(connect_(&handle), "pmdConnectFireWire");
    handle_ = handle;
  }
  void Close() override { CloseHandle(); }
  void Set(const DepthSettings& settings) override {
    if (settings.second_frequency_hz > 0.0)
      throw InputError(name_, "a library of generation 1 measures with one frequency");
    Check(set_integration_(handle_, Rounded(settings.integration_s * 1e6)), "pmdSetIntegrationTime");
    Check(set_frequency_(handle_, Rounded(settings.frequency_hz * 1e-6)), "pmdSetModulationFrequency");
    settings_ = settings;
  }
  PmdFrame WaitForFrame() override {
    Update();
    return {.settings = settings_,
            .range_m = Image(distances_, "pmdGetDistances"),
            .amplitude = Image(amplitudes_, "pmdGetAmplitudes"),
            .intensity = Image(intensities_, "pmdGetIntensities"),
            .flags = {}};
  }

 private:
  std::vector<float> Image(Pmd1GetImage* call, const char* name) const {
    double* image = nullptr;
    Check(call(handle_, &image), name);
    if (image == nullptr) throw MachineError(library_.path() + ": " + name + " gives no image");
    return {image, image + pixels_};
  }

  std::string name_;
  std::size_t pixels_;
  DepthSettings settings_;
  Pmd1ConnectFireWire* connect_;
  Pmd1SetIntegrationTime* set_integration_;
  Pmd1SetModulationFrequency* set_frequency_;
  Pmd1GetImage* distances_;
  Pmd1GetImage* amplitudes_;
  Pmd1GetImage* intensities_;
};

// A camera whose library may throw exceptions of its own, although its calls are those of C.
template <class Generation>
class Guarded final : public PmdCamera {
 public:
  Guarded(const PmdCameraConfig& config, const DepthCameraSheet& sheet)
      : path_(config.library), camera_(config, sheet) {}

  void Open() override {
    Guard([this] { camera_.Open(); });
  }
  void Close() override { camera_.Close(); }
  void Set(const DepthSettings& settings) override {
    Guard([&] { camera_.Set(settings); });
  }
  PmdFrame WaitForFrame() override {
    return Guard([this] { return camera_.WaitForFrame(); });
  }

 private:
  template <class Call>
  auto Guard(const Call& call) {
    try {
      return call();
    } catch (const InputError&) {
      throw;
    } catch (const MachineError&) {
      throw;
    } catch (const std::exception& error) {
      throw MachineError(path_ + ": the library threw: " + error.what());
    } catch (...) {
      throw MachineError(path_ + ": the library threw an unknown exception");
    }
  }

  std::string path_;
  Generation camera_;
};

}  // namespace

std::unique_ptr<PmdCamera> LoadPmdCamera(const PmdCameraConfig& config, const DepthCameraSheet& sheet) {
  if (config.generation == 1) return std::make_unique<Guarded<Generation1>>(config, sheet);
  return std::make_unique<Guarded<Generation2>>(config, sheet);
}

}  // namespace merlin
