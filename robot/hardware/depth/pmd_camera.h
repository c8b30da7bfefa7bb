// A ToF camera through its maker's library (robot/protocol/pmd_api.h), the same for both generations of its calls.
// Every call may block. A call that fails, or in which the library throws, throws MachineError with the library's own
// message.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "robot/types/depth_camera.h"

namespace merlin {

struct PmdCameraConfig {
  std::string library;  // path of the maker's shared library
  int generation = 2;   // of its calls: 2 (PMDSDK 2), 1 (MiniSDK 1: the first camera on the FireWire bus, no arguments)
  // Passed to the library unchanged; the documentation of the camera's SDK names them.
  std::string source_plugin;
  std::string source_argument;
  std::string processing_plugin;
  std::string processing_argument;
};

template <class Visitor>
void Visit(Visitor& v, PmdCameraConfig& c) {
  v("library", c.library);
  v("generation", c.generation, {1, 2});
  v("source_plugin", c.source_plugin);
  v("source_argument", c.source_argument);
  v("processing_plugin", c.processing_plugin);
  v("processing_argument", c.processing_argument);
}

// A frame as the library delivers it. Images that it does not have are empty: generation 1 has no flags.
struct PmdFrame {
  DepthSettings settings;  // as used
  std::vector<float> range_m, amplitude, intensity;
  std::vector<unsigned int> flags;
};

class PmdCamera {
 public:
  virtual ~PmdCamera() = default;
  // Throws InputError for a camera whose picture does not have the sheet's size.
  virtual void Open() = 0;
  virtual void Close() = 0;
  // Sets the nearest settings that the camera can use; they apply from the next exposure on.
  virtual void Set(const DepthSettings& settings) = 0;
  virtual PmdFrame WaitForFrame() = 0;
};

// Opens the library, not yet the camera. Throws InputError for a file that is not a library or lacks calls.
std::unique_ptr<PmdCamera> LoadPmdCamera(const PmdCameraConfig& config, const DepthCameraSheet& sheet);

}  // namespace merlin
