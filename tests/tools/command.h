// Runs a command as a user would type it, and captures how it ends.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace merlin {

struct Outcome {
  int code = -1;     // 128 plus the signal's number if a signal ended it
  std::string said;  // its standard output, and what the command itself sends there
};

inline Outcome Run(const std::string& command, const std::filesystem::path& folder) {
  Outcome outcome;
  FILE* pipe = popen(("cd '" + folder.string() + "' && " + command).c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) outcome.said.append(buffer.data(), n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

// Runs the program under test with these arguments. streams: redirections of its output.
inline Outcome Merlin(const std::string& arguments, const std::filesystem::path& folder,
                      const std::string& streams = "2>&1") {
  return Run("'" MERLIN_BINARY "' " + arguments + " " + streams, folder);
}

}  // namespace merlin
