#include "robot/emulated/depth_connection.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "robot/base/error.h"

namespace merlin {
namespace {

[[noreturn]] void Fail(const std::string& path, const std::string& what) {
  throw MachineError(path + ": " + what + ": " + std::strerror(errno));
}

sockaddr_un Address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    throw MachineError("'" + path + "': the path of a local socket has 1 to " +
                       std::to_string(sizeof address.sun_path - 1) + " bytes, got " + std::to_string(path.size()));
  path.copy(address.sun_path, path.size());
  return address;
}

int NewSocket(const std::string& path) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) Fail(path, "no socket");
  return socket;
}

}  // namespace

bool DepthConnection::Send(const WireMessage& message) {
  const std::vector<std::uint8_t> bytes = Encode(message);
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t more = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    sent += static_cast<std::size_t>(more);
  }
  return true;
}

std::optional<WireMessage> DepthConnection::Receive() {
  std::array<std::uint8_t, 65536> part;
  while (true) {
    WireReading reading = Decode(received_);
    if (reading.kind == WireReading::Kind::kGarbage) return std::nullopt;
    if (reading.kind == WireReading::Kind::kMessage) {
      received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(reading.bytes));
      return std::move(reading.message);
    }
    const ssize_t more = ::recv(socket_, part.data(), part.size(), 0);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return std::nullopt;
    received_.insert(received_.end(), part.begin(), part.begin() + more);
  }
}

int ListenAt(const std::string& path) {
  const sockaddr_un address = Address(path);
  const int socket = NewSocket(path);
  std::error_code error;
  if (std::filesystem::is_socket(path, error)) std::filesystem::remove(path, error);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 && ::listen(socket, 8) == 0)
    return socket;
  ::close(socket);
  Fail(path, "cannot listen on this socket");
}

int ConnectTo(const std::string& path) {
  const sockaddr_un address = Address(path);
  const int socket = NewSocket(path);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return socket;
  const int reason = errno;
  ::close(socket);
  errno = reason;
  Fail(path, "no camera answers there");
}

}  // namespace merlin
