// Runs child processes of this program, several at a time.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace merlin {

struct Command {
  std::vector<std::string> arguments;  // without the program's name
  std::filesystem::path log;           // gets all of its output
};

// Runs each command once, in order, at most at_a_time at once. Calls done(command, exit code) when one ends; the code
// is 128 plus the signal's number if a signal ended it. Once stop is set no further command starts, running ones are
// interrupted as by Ctrl-C, and all have ended when this returns. Children die with this process, however it ends; a
// Ctrl-C on the terminal reaches them only through this process. Throws MachineError if no process can be started,
// after the others have ended.
void RunCommands(std::span<const Command> commands, int at_a_time, const std::atomic<bool>& stop,
                 const std::function<void(std::size_t, int)>& done);

}  // namespace merlin
