#include "tools/sweep/process_pool.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>
#include <thread>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr char kProgram[] = "/proc/self/exe";
constexpr std::chrono::milliseconds kLook(20);

// Runs in the child, where only calls that are safe after a fork are allowed.
[[noreturn]] void Become(char* const* argv, const char* log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent ended before prctl took effect
  setpgid(0, 0);
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (in < 0 || out < 0 || dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(out, STDERR_FILENO) < 0)
    _exit(127);
  execv(kProgram, argv);
  _exit(127);
}

pid_t Start(const Command& command) {
  std::vector<char*> argv{const_cast<char*>("merlin")};
  for (const std::string& argument : command.arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) Become(argv.data(), command.log.c_str(), parent);
  if (child < 0) throw MachineError(std::string("no further process can be started: ") + std::strerror(errno));
  return child;
}

// The running children. None of them outlives this object.
class Children {
 public:
  ~Children() {
    Signal(SIGKILL);
    for (const auto& [child, index] : at_work_) waitpid(child, nullptr, 0);
  }
  Children() = default;
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  std::size_t count() const { return at_work_.size(); }
  void Add(pid_t child, std::size_t index) { at_work_[child] = index; }
  void Signal(int number) const {
    for (const auto& [child, index] : at_work_) kill(child, number);
  }
  // Reports the children that have ended.
  void Collect(const std::function<void(std::size_t, int)>& done) {
    for (auto child = at_work_.begin(); child != at_work_.end();) {
      int status = 0;
      if (waitpid(child->first, &status, WNOHANG) != child->first) {
        ++child;
        continue;
      }
      const std::size_t index = child->second;
      child = at_work_.erase(child);
      done(index, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    }
  }

 private:
  std::map<pid_t, std::size_t> at_work_;  // and the indices of their commands
};

}  // namespace

void RunCommands(std::span<const Command> commands, int at_a_time, const std::atomic<bool>& stop,
                 const std::function<void(std::size_t, int)>& done) {
  Children children;
  bool told = false;
  for (std::size_t next = 0; (next < commands.size() && !stop.load()) || children.count() > 0;) {
    for (; next < commands.size() && !stop.load() && children.count() < static_cast<std::size_t>(at_a_time); ++next)
      children.Add(Start(commands[next]), next);
    if (stop.load() && !told) {
      children.Signal(SIGINT);
      told = true;
    }
    children.Collect(done);
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace merlin
