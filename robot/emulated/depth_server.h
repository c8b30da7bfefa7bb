// The ToF camera that the vendor library (libmerlin_pmd.so) finds behind a local socket: frames that the twin publishes
// go out to it, its settings come in.
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include "robot/emulated/connection_server.h"
#include "robot/emulated/depth_wire.h"
#include "robot/emulated/newest.h"
#include "robot/types/depth_camera.h"

namespace merlin {

class DepthServer {
 public:
  using OnSettings = std::function<void(const DepthSettings&)>;

  // path: of the socket, the source argument of pmdOpen. on_settings: called on a thread of the server with settings
  // that the sheet allows; what it throws as InputError is refused. Throws MachineError where it cannot listen.
  DepthServer(const std::string& path, const DepthCameraSheet& sheet, const DepthSettings& settings,
              OnSettings on_settings);
  ~DepthServer();

  // From any thread. A client that waits for its next frame gets this one; it sees none from before it asked first.
  void Publish(const DepthFrame& frame);

  // How many have the camera open.
  int clients() const { return server_.connections(); }

 private:
  void Serve(int socket);
  WireMessage Hello();
  WireMessage NextFrame(std::uint64_t& seen);
  WireMessage Set(const WireSettings& settings);

  std::string path_;
  DepthCameraSheet sheet_;
  OnSettings on_settings_;
  Newest<WireFrame> frames_;
  std::mutex mutex_;  // of settings_, and of calls to on_settings_
  WireSettings settings_;
  ConnectionServer server_;
};

}  // namespace merlin
