// A camera on the network, for the colour driver to open: the twin's pictures as an endless MJPEG stream
// (multipart/x-mixed-replace) over HTTP on this machine alone.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "robot/emulated/connection_server.h"
#include "robot/emulated/newest.h"
#include "robot/types/color_camera.h"

namespace merlin {

class MjpegServer {
 public:
  // port 0: any free port. quality: of the JPEG, 1 to 100. Throws MachineError if it cannot listen.
  explicit MjpegServer(int port = 0, int quality = 95);
  ~MjpegServer();

  // http://127.0.0.1:<port>/stream.mjpg; any path gives the stream.
  const std::string& url() const { return url_; }
  int port() const { return port_; }
  // May be called from any thread. A client that is too slow skips pictures and gets the newest.
  void Publish(ColorFrame frame) { frames_.Put(std::move(frame)); }

 private:
  void Serve(int socket);

  int quality_;
  int port_ = 0;
  std::string url_;
  Newest<ColorFrame> frames_;
  std::optional<ConnectionServer> server_;  // last: it is destroyed before what it uses
};

}  // namespace merlin
