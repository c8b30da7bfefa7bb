#include "tools/drive/raw_terminal.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "robot/base/error.h"

namespace merlin {
namespace {

// A terminal and its keyboard.
struct Terminal {
  Terminal() {
    keyboard = posix_openpt(O_RDWR | O_NOCTTY);
    grantpt(keyboard);
    unlockpt(keyboard);
    screen = open(ptsname(keyboard), O_RDWR | O_NOCTTY);
  }
  ~Terminal() {
    close(screen);
    close(keyboard);
  }
  bool IsRaw() const {
    termios now{};
    tcgetattr(screen, &now);
    return (now.c_lflag & (ICANON | ECHO)) == 0;
  }
  void Type(const std::string& text) const {
    ASSERT_EQ(write(keyboard, text.data(), text.size()), ssize_t(text.size()));
  }
  void WaitForInput() const {
    pollfd ready{screen, POLLIN, 0};
    ASSERT_EQ(poll(&ready, 1, 10000), 1);
  }

  int keyboard = -1, screen = -1;
};

TEST(RawTerminal, HandsOutKeysAtOnceAndPutsTheTerminalBack) {
  const Terminal terminal;
  EXPECT_FALSE(terminal.IsRaw());
  {
    RawTerminal raw(terminal.screen);
    EXPECT_TRUE(terminal.IsRaw());
    EXPECT_EQ(raw.Read(), "");
    terminal.Type("w\x1b[A");
    terminal.WaitForInput();
    EXPECT_EQ(raw.Read(), "w\x1b[A");
    EXPECT_TRUE(raw.there());
  }
  EXPECT_FALSE(terminal.IsRaw());
}

TEST(RawTerminal, PutsTheTerminalBackForExceptionsAndForMainsOwnWayOut) {
  const Terminal terminal;
  EXPECT_THROW(
      {
        const RawTerminal raw(terminal.screen);
        throw MachineError("x");
      },
      MachineError);
  EXPECT_FALSE(terminal.IsRaw());
  const RawTerminal raw(terminal.screen);
  RestoreTerminal();
  EXPECT_FALSE(terminal.IsRaw());
  RestoreTerminal();
}

TEST(RawTerminal, PutsTheTerminalBackBeforeASignalKills) {
  for (const int signal : {SIGQUIT, SIGABRT, SIGSEGV}) {
    const Terminal terminal;
    const pid_t child = fork();
    if (child == 0) {
      const RawTerminal raw(terminal.screen);
      if (!terminal.IsRaw()) _exit(1);
      raise(signal);
      _exit(2);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << signal;
    EXPECT_FALSE(terminal.IsRaw()) << signal;
  }
}

TEST(RawTerminal, RejectsAFileThatIsNotATerminal) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  EXPECT_THROW(RawTerminal{pipe_ends[0]}, InputError);
  close(pipe_ends[0]);
  close(pipe_ends[1]);
  EXPECT_THROW(RawTerminal{-1}, InputError);
}

TEST(RawTerminal, NoticesThatTheTerminalHasGone) {
  Terminal terminal;
  RawTerminal raw(terminal.screen);
  close(terminal.keyboard);
  terminal.keyboard = -1;
  // A pseudo-terminal without its other end reads as an error or as the end of input, by the kernel's choice.
  EXPECT_EQ(raw.Read(), "");
}

}  // namespace
}  // namespace merlin
