// A vendor's library, generation 2, that throws exceptions through its C functions after some frames: all at 2 m, with
// as many columns and rows as the environment says ("COLUMNSxROWSxFRAMES", default 8x6x3).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "robot/protocol/pmd_api.h"

namespace {

using namespace merlin;

unsigned int columns = 8, rows = 6, frames_left = 3;

template <class Number>
int Fill(Number* image, std::size_t bytes, Number value) {
  std::fill_n(image, bytes / sizeof(Number), value);
  return kPmdOk;
}

}  // namespace

extern "C" {

int pmdOpen(PmdHandle* handle, const char*, const char*, const char*, const char*) {
  const char* asked = std::getenv("MERLIN_THROWING_PMD");
  if (asked != nullptr && std::sscanf(asked, "%ux%ux%u", &columns, &rows, &frames_left) != 3) return 1;
  if (asked != nullptr) ::unsetenv("MERLIN_THROWING_PMD");  // opened again it has none left
  *handle = 1;
  return kPmdOk;
}
int pmdUpdate(PmdHandle) {
  std::this_thread::sleep_for(std::chrono::milliseconds(frames_left > 0 ? 50 : 1));
  if (frames_left == 0) throw std::runtime_error("the lamp has burnt out");
  --frames_left;
  return kPmdOk;
}
int pmdClose(PmdHandle) { throw 1; }
int pmdGetLastError(PmdHandle, char* text, std::size_t) {
  text[0] = '\0';
  return kPmdOk;
}
int pmdSetIntegrationTime(PmdHandle, unsigned int, unsigned int) { return kPmdOk; }
int pmdGetValidIntegrationTime(PmdHandle, unsigned int* valid_us, unsigned int, PmdProximity, unsigned int time_us) {
  *valid_us = time_us;
  return kPmdOk;
}
int pmdSetModulationFrequency(PmdHandle, unsigned int, unsigned int) { return kPmdOk; }
int pmdGetValidModulationFrequency(PmdHandle, unsigned int* valid_hz, unsigned int, PmdProximity, unsigned int hz) {
  *valid_hz = hz;
  return kPmdOk;
}
int pmdGetDistances(PmdHandle, float* range_m, std::size_t bytes) { return Fill(range_m, bytes, 2.0f); }
int pmdGetAmplitudes(PmdHandle, float* amplitude, std::size_t bytes) { return Fill(amplitude, bytes, 5000.0f); }
int pmdGetIntensities(PmdHandle, float* intensity, std::size_t bytes) { return Fill(intensity, bytes, 100.0f); }
int pmdGetFlags(PmdHandle, unsigned int* flags, std::size_t bytes) { return Fill(flags, bytes, 0u); }
int pmdGetSourceDataDescription(PmdHandle, PmdDescription* description) {
  *description = {};
  description->columns = columns;
  description->rows = rows;
  description->integration_us[0] = 1000;
  description->frequency_hz[0] = 20'000'000;
  return kPmdOk;
}

}  // extern "C"
