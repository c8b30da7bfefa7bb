// One end of a connection that carries the messages of depth_wire.h. Blocks; belongs to one thread.
#pragma once

#include <string>

#include "robot/emulated/depth_wire.h"

namespace merlin {

class DepthConnection {
 public:
  explicit DepthConnection(int socket) : socket_(socket) {}  // the caller closes it

  // False: the other end is gone.
  bool Send(const WireMessage& message);
  // Empty: the other end is gone, sent nothing within the socket's time limit, or sent garbage.
  std::optional<WireMessage> Receive();

 private:
  int socket_;
  std::vector<std::uint8_t> received_;
};

// A local stream socket. Throws MachineError.
int ListenAt(const std::string& path);  // replaces a socket that an earlier run left behind
int ConnectTo(const std::string& path);

}  // namespace merlin
