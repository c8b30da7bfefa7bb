// The ToF camera that the vendor library (libmerlin_pmd.so) finds behind a local socket. It sends the frames that the
// twin publishes, and receives settings.
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

  // path: of the socket; a client gives it to pmdOpen as source argument. on_settings: called on a thread of the server
  // with settings that the sheet allows; if it throws InputError, the client is told that they are refused. Throws
  // MachineError if it cannot listen.
  DepthServer(const std::string& path, const DepthCameraSheet& sheet, const DepthSettings& settings,
              OnSettings on_settings);
  ~DepthServer();

  // May be called from any thread. A client that waits for its next frame gets this one. A client never gets a frame
  // that is older than its first request.
  void Publish(const DepthFrame& frame);

  // The number of clients that have the camera open.
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
