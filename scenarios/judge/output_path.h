// Checks a path that the user gives with --out or another option. A bad path is bad input (exit code 2), and is
// reported before the work whose result it is to hold.
#pragma once

#include <filesystem>
#include <string>

namespace merlin {

// Throws InputError, and changes nothing, if the file cannot be written: the path is empty or that of a folder or
// device, its folder does not exist, or permission is missing. Throws MachineError if the disk is full. option: the
// command-line option, for the message.
void CheckOutputFile(const std::filesystem::path& file, const std::string& option = "--out");

// Throw InputError. error: a value of errno; if it says that the disk is full or broken, throws MachineError.
[[noreturn]] void RefuseOutput(const std::filesystem::path& path, const std::string& what, int error,
                               const std::string& option = "--out");
[[noreturn]] void RefuseOutput(const std::filesystem::path& path, const std::string& expected, const std::string& got,
                               const std::string& option = "--out");

}  // namespace merlin
