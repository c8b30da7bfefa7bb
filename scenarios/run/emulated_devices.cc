#include "scenarios/run/emulated_devices.h"

#include <cstdlib>
#include <string>

#include "robot/base/error.h"

namespace merlin {
namespace {

std::string PmdLibrary() {
  const char* other = std::getenv("MERLIN_PMD_LIBRARY");
  return other != nullptr ? other : MERLIN_PMD_LIBRARY;
}

}  // namespace

SocketFolder::SocketFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "merlin-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw MachineError(name + ": cannot make a folder for the devices' sockets");
  path_ = name;
}

SocketFolder::~SocketFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

HardwareConfig DevicesOf(const EmulatedRobot& emulated) {
  HardwareConfig config;
  config.drive.serial = {emulated.drive_port(), EmulatedRobot::kDriveBaud};
  if (const auto port = emulated.compass_port()) config.compass.emplace().serial = {*port, 9600};
  config.depth.pmd.library = PmdLibrary();
  config.depth.pmd.source_argument = emulated.depth_socket();
  if (const auto url = emulated.color_url()) {
    config.color.emplace().source = *url;
    config.color->stream_latency_s = EmulatedRobot::kStreamLatency_s;
  }
  return config;
}

}  // namespace merlin
