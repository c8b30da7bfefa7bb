// Runs child processes of this very program, several at a time.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace merlin {

struct Command {
  std::vector<std::string> arguments;  // after the program's name
  std::filesystem::path log;           // takes all that it says
};

// Each command once, in order, so many at a time; done(command, exit code) as each ends (128 and the signal's number where
// one ended it). Once stop is set none begins, those at work are interrupted as by Ctrl-C, and all have ended at the
// return. Children die with this process, whatever ends it; a Ctrl-C on the terminal reaches them through it alone.
// Throws MachineError where no process can be made, once the others have ended.
void RunCommands(std::span<const Command> commands, int at_a_time, const std::atomic<bool>& stop,
                 const std::function<void(std::size_t, int)>& done);

}  // namespace merlin
