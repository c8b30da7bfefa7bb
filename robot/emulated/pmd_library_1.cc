// The twin's stand-in for the ToF camera maker's library, generation 1 of the calls (robot/protocol/pmd_api.h): a
// library of its own, because the two generations have calls of the same name with different shapes. Its camera on the
// FireWire bus is the DepthServer whose path is in the environment variable MERLIN_PMD_SOCKET.
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "robot/emulated/pmd_clients.h"

namespace {

using namespace merlin;

struct Images {
  std::vector<double> range_m, amplitude, intensity;
};

// What the library owns; valid until a camera's next update.
struct State {
  PmdClients clients;
  std::mutex mutex;
  std::map<PmdHandle, Images> images;
};
State& TheState() {
  static State state;
  return state;
}

Images& ImagesOf(PmdHandle handle) {
  const std::lock_guard lock(TheState().mutex);
  return TheState().images[handle];
}

int Give(PmdHandle handle, std::vector<double> Images::*which, double** image) {
  return TheState().clients.Do(handle, [=](PmdClient& client) {
    client.frame();  // throws before the first update
    *image = (ImagesOf(handle).*which).data();
  });
}

}  // namespace

#define PMD_CALL(name, shape)                                   \
  extern "C" __attribute__((visibility("default"))) shape name; \
  int name

PMD_CALL(pmdConnectFireWire, Pmd1ConnectFireWire)(PmdHandle* handle) {
  const char* const path = std::getenv("MERLIN_PMD_SOCKET");
  return TheState().clients.Open(handle, path == nullptr ? "" : path);
}

PMD_CALL(pmdClose, PmdClose)(PmdHandle handle) {
  {
    const std::lock_guard lock(TheState().mutex);
    TheState().images.erase(handle);
  }
  return TheState().clients.Close(handle);
}

PMD_CALL(pmdUpdate, PmdUpdate)(PmdHandle handle) {
  return TheState().clients.Do(handle, [=](PmdClient& client) {
    client.Update();
    const WireFrame& frame = client.frame();
    ImagesOf(handle) = {.range_m = {frame.range_m.begin(), frame.range_m.end()},
                        .amplitude = {frame.amplitude.begin(), frame.amplitude.end()},
                        .intensity = {frame.intensity.begin(), frame.intensity.end()}};
  });
}

PMD_CALL(pmdSetIntegrationTime, Pmd1SetIntegrationTime)(PmdHandle handle, unsigned int time_us) {
  return TheState().clients.Do(handle, [=](PmdClient& client) {
    WireSettings settings = client.hello().settings;
    settings.integration_us = time_us;
    client.Set(settings);
  });
}

PMD_CALL(pmdSetModulationFrequency, Pmd1SetModulationFrequency)(PmdHandle handle, unsigned int frequency_mhz) {
  return TheState().clients.Do(handle, [=](PmdClient& client) {
    WireSettings settings = client.hello().settings;
    settings.frequency_hz = frequency_mhz * 1000000;
    client.Set(settings);
  });
}

PMD_CALL(pmdGetDistances, Pmd1GetImage)(PmdHandle handle, double** image) {
  return Give(handle, &Images::range_m, image);
}
PMD_CALL(pmdGetAmplitudes, Pmd1GetImage)(PmdHandle handle, double** image) {
  return Give(handle, &Images::amplitude, image);
}
PMD_CALL(pmdGetIntensities, Pmd1GetImage)(PmdHandle handle, double** image) {
  return Give(handle, &Images::intensity, image);
}

PMD_CALL(pmdGetLastError, PmdGetLastError)(PmdHandle handle, char* text, std::size_t bytes) {
  return TheState().clients.LastError(handle, text, bytes);
}
