// The calls of the ToF camera maker's library, declared by us: the maker's own headers are not ours to ship. These
// declarations follow the shapes that public programs call (names, order and kind of the arguments), nothing else of
// the maker's. Where such a program does not show it (the order of the description's fields), the layout is ours, and a
// library that lays it out otherwise needs PmdDescription changed here.
#pragma once

#include <cstddef>

namespace merlin {

extern "C" {

using PmdHandle = unsigned int;  // of an open camera; 0: none

constexpr int kPmdOk = 0;  // what every call returns if there was no error

// Which valid value a pmdGetValid... call looks for.
enum PmdProximity { kPmdCloseTo = 0, kPmdAtLeast = 1, kPmdAtMost = 2 };

// Of the frame that the last pmdUpdate fetched.
struct PmdDescription {
  unsigned int columns;
  unsigned int rows;
  unsigned int integration_us[4];  // one an exposure; 0: not used
  unsigned int frequency_hz[4];
  int offset[4];
  unsigned int pixel_origin;  // 0: upper left
  unsigned int stamp_high, stamp_low;
  unsigned int reserved[47];  // room for a library whose description is longer: 256 bytes in all
};
static_assert(sizeof(PmdDescription) == 256);

// Generation 2, PMDSDK 2: the caller's memory, sizes in bytes, an index for each exposure of a frame. Images are
// row-major, upper left first; flags are those of DepthFlag.
using PmdOpen = int(PmdHandle* handle, const char* source_plugin, const char* source_argument,
                    const char* processing_plugin, const char* processing_argument);
using PmdClose = int(PmdHandle handle);
using PmdUpdate = int(PmdHandle handle);  // waits for the next frame
using PmdSetIntegrationTime = int(PmdHandle handle, unsigned int index, unsigned int time_us);
using PmdGetValidIntegrationTime = int(PmdHandle handle, unsigned int* valid_us, unsigned int index, PmdProximity which,
                                       unsigned int time_us);
using PmdSetModulationFrequency = int(PmdHandle handle, unsigned int index, unsigned int frequency_hz);
using PmdGetValidModulationFrequency = int(PmdHandle handle, unsigned int* valid_hz, unsigned int index,
                                           PmdProximity which, unsigned int frequency_hz);
using PmdGetDistances = int(PmdHandle handle, float* range_m, std::size_t bytes);
using PmdGetAmplitudes = int(PmdHandle handle, float* amplitude, std::size_t bytes);
using PmdGetIntensities = int(PmdHandle handle, float* intensity, std::size_t bytes);
using PmdGetFlags = int(PmdHandle handle, unsigned int* flags, std::size_t bytes);
using PmdGet3DCoordinates = int(PmdHandle handle, float* xyz_m, std::size_t bytes);  // optical frame, x y z a pixel
using PmdGetSourceDataSize = int(PmdHandle handle, std::size_t* bytes);
using PmdGetSourceData = int(PmdHandle handle, void* data, std::size_t bytes);
using PmdGetSourceDataDescription = int(PmdHandle handle, PmdDescription* description);
using PmdSourceCommand = int(PmdHandle handle, char* answer, std::size_t bytes, const char* command);
using PmdProcessingCommand = int(PmdHandle handle, char* answer, std::size_t bytes, const char* command);
using PmdGetLastError = int(PmdHandle handle, char* text, std::size_t bytes);  // handle 0: of pmdOpen

// Generation 1, MiniSDK 1, where it differs: numbers are doubles in memory of the library, valid until the next update;
// no index, frequencies in MHz, the first camera on the FireWire bus. It tells no size, flags or settings.
using Pmd1ConnectFireWire = int(PmdHandle* handle);
using Pmd1SetIntegrationTime = int(PmdHandle handle, unsigned int time_us);
using Pmd1SetModulationFrequency = int(PmdHandle handle, unsigned int frequency_mhz);
using Pmd1GetImage = int(PmdHandle handle, double** image);  // pmdGetDistances, pmdGetAmplitudes, pmdGetIntensities

}  // extern "C"

}  // namespace merlin
