#include "tools/drive/raw_terminal.h"

#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "robot/base/error.h"

namespace merlin {
namespace {

// Global because signal handlers need them: the terminal in raw mode, and its former mode.
std::atomic<int> raw_fd{-1};
termios saved{};

void OnDeath(int signal) {
  RestoreTerminal();
  raise(signal);  // now with its default effect: the handler was installed for one signal
}

}  // namespace

void RestoreTerminal() {
  const int fd = raw_fd.exchange(-1);
  if (fd >= 0) tcsetattr(fd, TCSANOW, &saved);
}

RawTerminal::RawTerminal(int fd) : fd_(fd) {
  if (tcgetattr(fd, &saved) != 0) throw InputError("--keyboard", "the input is no terminal", "to be started from one");
  if (const pid_t foreground = tcgetpgrp(fd); foreground >= 0 && foreground != getpgrp())
    throw InputError("--keyboard", "this program is in the background", "to be started in the foreground");
  termios raw = saved;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = raw.c_cc[VTIME] = 0;
  struct sigaction action {};
  action.sa_handler = OnDeath;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < kDeadly.size(); ++i) sigaction(kDeadly[i], &action, &before_[i]);
  action.sa_handler = SIG_IGN;
  action.sa_flags = 0;
  sigaction(SIGTSTP, &action, &suspend_before_);
  raw_fd = fd;
  tcsetattr(fd, TCSANOW, &raw);
}

RawTerminal::~RawTerminal() {
  RestoreTerminal();
  for (std::size_t i = 0; i < kDeadly.size(); ++i) sigaction(kDeadly[i], &before_[i], nullptr);
  sigaction(SIGTSTP, &suspend_before_, nullptr);
}

std::string RawTerminal::Read() {
  std::array<char, 256> buffer;
  const ssize_t size = read(fd_, buffer.data(), buffer.size());
  if (size < 0 && errno != EAGAIN && errno != EINTR) there_ = false;
  return size > 0 ? std::string(buffer.data(), static_cast<std::size_t>(size)) : std::string();
}

}  // namespace merlin
