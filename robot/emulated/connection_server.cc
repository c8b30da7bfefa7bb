#include "robot/emulated/connection_server.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace merlin {
namespace {

constexpr std::size_t kConnectionsMax = 8;

}  // namespace

ConnectionServer::ConnectionServer(int listening, std::function<void(int)> serve)
    : listening_(listening), serve_(std::move(serve)), thread_([this] { Accept(); }) {}

ConnectionServer::~ConnectionServer() {
  stop_ = true;
  ::shutdown(listening_, SHUT_RDWR);  // wakes accept
  thread_.join();
  ::close(listening_);
}

void ConnectionServer::Accept() {
  while (!stop_) {
    const int socket = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0 && (errno == EINTR || errno == ECONNABORTED)) continue;
    if (socket < 0) break;
    Forget(false);
    if (connections_.size() >= kConnectionsMax) {
      ::close(socket);
      continue;
    }
    Connection& connection = connections_.emplace_back(socket);
    ++serving_;
    connection.thread = std::thread([this, &connection] {
      try {
        serve_(connection.socket);
      } catch (...) {  // an error of one connection ends that connection only
      }
      ::shutdown(connection.socket, SHUT_RDWR);  // tells the other end at once; Forget frees the number
      --serving_;
      connection.over = true;
    });
  }
  Forget(true);
}

void ConnectionServer::Forget(bool all) {
  for (auto connection = connections_.begin(); connection != connections_.end();) {
    if (!all && !connection->over) {
      ++connection;
      continue;
    }
    ::shutdown(connection->socket, SHUT_RDWR);
    connection->thread.join();
    ::close(connection->socket);
    connection = connections_.erase(connection);
  }
}

}  // namespace merlin
