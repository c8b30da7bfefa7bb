#include "robot/description/apart.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "robot/base/error.h"

namespace merlin {
namespace {

void LimitChild() {
  const rlimit no_core{0, 0}, cpu{kApartCpuMax_s, kApartCpuMax_s};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &cpu);
// Sanitizers map much more than that for themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit memory{kApartMemoryMax_bytes, kApartMemoryMax_bytes};
  setrlimit(RLIMIT_DATA, &memory);
#endif
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU}) std::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
}

bool WriteAll(int file, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t written = write(file, bytes.data() + at, bytes.size() - at);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) at += static_cast<std::size_t>(written);
  }
  return true;
}

std::string ReadAll(int file) {
  std::string bytes;
  std::array<char, 65536> buffer;
  while (true) {
    const ssize_t got = read(file, buffer.data(), buffer.size());
    if (got > 0) bytes.append(buffer.data(), static_cast<std::size_t>(got));
    if (got == 0 || (got < 0 && errno != EINTR)) return bytes;
  }
}

}  // namespace

ApartResult RunApart(const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw MachineError("no pipe to another process: too many open files");
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]), close(ends[1]);
    throw MachineError("no other process can be started: too many processes or too little memory");
  }
  if (child == 0) {
    LimitChild();
    _exit(WriteAll(ends[1], work()) ? 0 : 1);
  }
  close(ends[1]);
  ApartResult result;
  result.bytes = ReadAll(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.finished = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return result;
}

}  // namespace merlin
