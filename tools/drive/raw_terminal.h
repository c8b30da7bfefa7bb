// A terminal that hands out every key at once and shows none. It is put back as it was when this ends, however the
// program ends: exceptions, signals that kill it, and main's own way out (RestoreTerminal). Only one at a time. Ctrl-C
// stays a signal; Ctrl-Z does nothing meanwhile: a car under way is not to be suspended.
#pragma once

#include <signal.h>

#include <array>
#include <string>

namespace merlin {

class RawTerminal {
 public:
  // Throws InputError: no terminal, or this program is in the background.
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

// Puts the terminal back, if it is raw; may be called in a signal handler.
void RestoreTerminal();

}  // namespace merlin
