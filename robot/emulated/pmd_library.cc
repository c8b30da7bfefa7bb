// The twin's stand-in for the ToF camera maker's library, generation 2 of the calls (robot/protocol/pmd_api.h). The
// source argument of pmdOpen is the path of the running twin's DepthServer; plugins and the processing argument are
// ignored. Amplitudes are electrons, intensities 0 .. 255 at the full well. No raw data, and no commands: they are the
// maker's own.
#include <algorithm>
#include <cstdlib>
#include <type_traits>
#include <vector>

#include "robot/base/error.h"
#include "robot/emulated/pmd_clients.h"

namespace {

using namespace merlin;

PmdClients& Clients() {
  static PmdClients clients;
  return clients;
}

// The valid value on the requested side; throws MachineError if there is none.
unsigned int Valid(std::vector<std::uint32_t> candidates, PmdProximity which, unsigned int value) {
  std::ranges::sort(candidates);
  std::erase_if(candidates, [=](unsigned int valid) {
    return (which == kPmdAtLeast && valid < value) || (which == kPmdAtMost && valid > value);
  });
  if (candidates.empty()) throw MachineError("no valid value on that side");
  return *std::ranges::min_element(candidates, {},
                                   [=](unsigned int valid) { return valid > value ? valid - value : value - valid; });
}

int NotHere(PmdHandle handle, const char* what) {
  return Clients().Do(handle,
                      [=](PmdClient&) { throw MachineError(std::string("the emulated camera has no ") + what); });
}

}  // namespace

// Exports a call, and checks that it has the shape that the driver expects.
#define PMD_CALL(name, shape)                                   \
  extern "C" __attribute__((visibility("default"))) shape name; \
  int name

PMD_CALL(pmdOpen, PmdOpen)
(PmdHandle* handle, const char*, const char* source_argument, const char*, const char*) {
  return Clients().Open(handle, source_argument == nullptr ? "" : source_argument);
}

PMD_CALL(pmdClose, PmdClose)(PmdHandle handle) { return Clients().Close(handle); }

PMD_CALL(pmdUpdate, PmdUpdate)(PmdHandle handle) {
  return Clients().Do(handle, [](PmdClient& client) { client.Update(); });
}

PMD_CALL(pmdGetValidIntegrationTime, PmdGetValidIntegrationTime)
(PmdHandle handle, unsigned int* valid_us, unsigned int, PmdProximity which, unsigned int time_us) {
  return Clients().Do(handle, [=](PmdClient& client) {
    const WireHello& hello = client.hello();
    const unsigned int inside_us = std::clamp(time_us, hello.integration_min_us, hello.integration_max_us);
    *valid_us = Valid({inside_us}, which, time_us);
  });
}

PMD_CALL(pmdSetIntegrationTime, PmdSetIntegrationTime)
(PmdHandle handle, unsigned int index, unsigned int time_us) {
  return Clients().Do(handle, [=](PmdClient& client) {
    if (index != 0) throw MachineError("the camera has one integration time, index 0");
    WireSettings settings = client.hello().settings;
    settings.integration_us = time_us;
    client.Set(settings);
  });
}

PMD_CALL(pmdGetValidModulationFrequency, PmdGetValidModulationFrequency)
(PmdHandle handle, unsigned int* valid_hz, unsigned int, PmdProximity which, unsigned int frequency_hz) {
  return Clients().Do(
      handle, [=](PmdClient& client) { *valid_hz = Valid(client.hello().frequencies_hz, which, frequency_hz); });
}

PMD_CALL(pmdSetModulationFrequency, PmdSetModulationFrequency)
(PmdHandle handle, unsigned int index, unsigned int frequency_hz) {
  return Clients().Do(handle, [=](PmdClient& client) {
    if (index > 1) throw MachineError("the camera has two modulation frequencies, index 0 and 1");
    WireSettings settings = client.hello().settings;
    (index == 0 ? settings.frequency_hz : settings.second_frequency_hz) = frequency_hz;
    client.Set(settings);
  });
}

PMD_CALL(pmdGetDistances, PmdGetDistances)(PmdHandle handle, float* range_m, std::size_t bytes) {
  return Clients().Do(handle, [=](PmdClient& client) {
    const auto& image = client.frame().range_m;
    CopyOut(image.data(), image.size() * sizeof(float), range_m, bytes);
  });
}

PMD_CALL(pmdGetAmplitudes, PmdGetAmplitudes)(PmdHandle handle, float* amplitude, std::size_t bytes) {
  return Clients().Do(handle, [=](PmdClient& client) {
    const auto& image = client.frame().amplitude;
    CopyOut(image.data(), image.size() * sizeof(float), amplitude, bytes);
  });
}

PMD_CALL(pmdGetIntensities, PmdGetIntensities)(PmdHandle handle, float* intensity, std::size_t bytes) {
  return Clients().Do(handle, [=](PmdClient& client) {
    const std::vector<float> image(client.frame().intensity.begin(), client.frame().intensity.end());
    CopyOut(image.data(), image.size() * sizeof(float), intensity, bytes);
  });
}

PMD_CALL(pmdGetFlags, PmdGetFlags)(PmdHandle handle, unsigned int* flags, std::size_t bytes) {
  return Clients().Do(handle, [=](PmdClient& client) {
    const std::vector<unsigned int> image(client.frame().flags.begin(), client.frame().flags.end());
    CopyOut(image.data(), image.size() * sizeof(unsigned int), flags, bytes);
  });
}

PMD_CALL(pmdGet3DCoordinates, PmdGet3DCoordinates)(PmdHandle handle, float* xyz_m, std::size_t bytes) {
  return Clients().Do(handle, [=](PmdClient& client) {
    const WireFrame& frame = client.frame();
    std::vector<float> image;
    for (std::size_t i = 0; i < frame.range_m.size(); ++i) {
      const Eigen::Vector3d ray =
          client.hello().camera.Ray(static_cast<double>(i % frame.columns), static_cast<double>(i / frame.columns));
      for (const double share : ray) image.push_back(static_cast<float>(share * frame.range_m[i]));
    }
    CopyOut(image.data(), image.size() * sizeof(float), xyz_m, bytes);
  });
}

PMD_CALL(pmdGetSourceDataDescription, PmdGetSourceDataDescription)(PmdHandle handle, PmdDescription* description) {
  return Clients().Do(handle, [=](PmdClient& client) {
    *description = {};
    const WireFrame* const frame = client.last_frame();
    const WireSettings settings = frame != nullptr ? frame->settings : client.hello().settings;
    const std::uint64_t stamp_ns = frame != nullptr ? frame->stamp_ns : 0;
    description->columns = frame != nullptr ? frame->columns : static_cast<unsigned int>(client.hello().camera.width);
    description->rows = frame != nullptr ? frame->rows : static_cast<unsigned int>(client.hello().camera.height);
    description->integration_us[0] = settings.integration_us;
    description->frequency_hz[0] = settings.frequency_hz;
    description->frequency_hz[1] = settings.second_frequency_hz;
    description->stamp_high = static_cast<unsigned int>(stamp_ns >> 32);
    description->stamp_low = static_cast<unsigned int>(stamp_ns);
  });
}

PMD_CALL(pmdGetSourceDataSize, PmdGetSourceDataSize)(PmdHandle handle, std::size_t*) {
  return NotHere(handle, "raw data");
}
PMD_CALL(pmdGetSourceData, PmdGetSourceData)(PmdHandle handle, void*, std::size_t) {
  return NotHere(handle, "raw data");
}
PMD_CALL(pmdSourceCommand, PmdSourceCommand)(PmdHandle handle, char*, std::size_t, const char*) {
  return NotHere(handle, "source commands");
}
PMD_CALL(pmdProcessingCommand, PmdProcessingCommand)(PmdHandle handle, char*, std::size_t, const char*) {
  return NotHere(handle, "processing commands");
}

PMD_CALL(pmdGetLastError, PmdGetLastError)(PmdHandle handle, char* text, std::size_t bytes) {
  return Clients().LastError(handle, text, bytes);
}
