// Accepts connections on a listening socket and serves each on a thread of its own, eight at most.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <thread>

namespace merlin {

class ConnectionServer {
 public:
  // Takes over the listening socket. serve: talks until the other end is gone; the socket is closed after it.
  ConnectionServer(int listening, std::function<void(int socket)> serve);
  // Cuts every connection: a call of serve that waits on its socket is woken.
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
  std::list<Connection> connections_;  // the accepting thread's
  std::atomic<int> serving_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace merlin
