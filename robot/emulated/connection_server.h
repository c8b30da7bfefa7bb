// Accepts connections on a listening socket and serves each on a thread of its own, eight at most.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <thread>

namespace merlin {

class ConnectionServer {
 public:
  // Takes over the listening socket. serve: handles one connection until the other end is gone. The socket is closed
  // when it returns.
  ConnectionServer(int listening, std::function<void(int socket)> serve);
  // Shuts every connection down, which wakes a call of serve that waits on its socket.
  ~ConnectionServer();
  ConnectionServer(const ConnectionServer&) = delete;
  ConnectionServer& operator=(const ConnectionServer&) = delete;

  // How many are served now.
  int connections() const { return serving_; }

 private:
  struct Connection {
    explicit Connection(int accepted) : socket(accepted) {}
    int socket;
    std::atomic<bool> over = false;
    std::thread thread;
  };
  void Accept();
  void Forget(bool all);

  int listening_;
  std::function<void(int)> serve_;
  std::list<Connection> connections_;  // used by the accepting thread only
  std::atomic<int> serving_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace merlin
