// A terminal with a given number of columns.
#pragma once

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/command.h"

namespace merlin {

// Runs a shell command on it. Returns how it ended, and all output to the screen. columns 0: the width is not known.
inline Outcome OnTerminal(const std::string& command, unsigned short columns, const std::filesystem::path& folder) {
  winsize size{.ws_row = 24, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  int screen = -1;
  const pid_t child = forkpty(&screen, nullptr, nullptr, &size);
  if (child == 0) {
    const std::string whole = "cd '" + folder.string() + "' && " + command;
    execl("/bin/sh", "sh", "-c", whole.c_str(), nullptr);
    _exit(127);
  }
  Outcome outcome;
  std::array<char, 4096> buffer;
  for (ssize_t n; (n = read(screen, buffer.data(), buffer.size())) > 0;)
    outcome.said.append(buffer.data(), static_cast<std::size_t>(n));
  close(screen);
  int status = 0;
  waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

// What each line showed, including lines that were overwritten, without the control codes.
inline std::vector<std::string> ScreenLines(const std::string& sent) {
  std::vector<std::string> lines{""};
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent.compare(i, 3, "\033[K") == 0)
      i += 2;
    else if (sent[i] == '\r' || sent[i] == '\n')
      lines.emplace_back();
    else
      lines.back() += sent[i];
  }
  return lines;
}

}  // namespace merlin
