// A program that runs beside the test, as if a user had started it in another terminal.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace merlin {

class Program {
 public:
  // Starts it in folder, where the file "<name>.txt" gets its output. Kills it in the end if it still runs.
  Program(const std::string& name, const std::string& binary, std::vector<std::string> arguments,
          const std::filesystem::path& folder)
      : said_(folder / (name + ".txt")) {
    arguments.insert(arguments.begin(), binary);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ != 0) return;
    const int out = open(said_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(out, STDERR_FILENO) < 0 || chdir(folder.c_str()) != 0)
      _exit(127);
    execv(binary.c_str(), argv.data());
    _exit(127);
  }
  ~Program() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    Wait();
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Signal(int number) const { kill(child_, number); }
  // Its exit code; 128 plus the signal's number if a signal ended it.
  int Wait() {
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  std::string Said() const { return Contents(said_); }
  bool HasSaid(const std::string& text) const { return Said().find(text) != std::string::npos; }

 private:
  std::filesystem::path said_;
  pid_t child_ = -1;
};

}  // namespace merlin
