// Switches a terminal to raw mode: every key is available at once, and none is shown. The former mode comes back in the end,
// however the program ends: by an exception, by a signal that kills it, or through main's own exit (RestoreTerminal). Only one
// object at a time. Ctrl-C stays a signal. Ctrl-Z does nothing, because a program that drives a car must not be suspended.
#pragma once

#include <signal.h>

#include <array>
#include <string>

namespace merlin {

class RawTerminal {
 public:
  // Throws InputError if fd is not a terminal, or if this program runs in the background.
  explicit RawTerminal(int fd);
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  // What has been typed since the last call; never waits.
  std::string Read();
  // False once the terminal has been closed.
  bool there() const { return there_; }

 private:
  static constexpr std::array kDeadly = {SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL};

  int fd_;
  bool there_ = true;
  std::array<struct sigaction, kDeadly.size()> before_{};
  struct sigaction suspend_before_ {};
};

// Restores the terminal if it is in raw mode. May be called in a signal handler.
void RestoreTerminal();

}  // namespace merlin
