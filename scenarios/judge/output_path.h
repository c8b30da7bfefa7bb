// A path that the user names with --out or another option, and why it cannot be used. A bad one is bad input (exit code 2) wherever it is
// given, and it is found before the work whose result it is to hold.
#pragma once

#include <filesystem>
#include <string>

namespace merlin {

// Throws InputError, with nothing changed, for a file that cannot be written: an empty path, a folder or a device of that
// name, no folder around it, no permission. MachineError when the disk is full. option: what named it.
void CheckOutputFile(const std::filesystem::path& file, const std::string& option = "--out");

// Throw InputError. error: of errno; MachineError where it says that the disk is full or broken.
[[noreturn]] void RefuseOutput(const std::filesystem::path& path, const std::string& what, int error,
                               const std::string& option = "--out");
[[noreturn]] void RefuseOutput(const std::filesystem::path& path, const std::string& expected, const std::string& got,
                               const std::string& option = "--out");

}  // namespace merlin
