// A path that the user names with --out, and why it cannot be used. A bad one is bad input (exit code 2) wherever it is
// given, and it is found before the work whose result it is to hold.
#pragma once

#include <filesystem>
#include <string>

namespace merlin {

// Throws InputError, with nothing changed, for a file that cannot be written: an empty path, a folder or a device of that
// name, no folder around it, no permission. MachineError when the disk is full.
void CheckOutputFile(const std::filesystem::path& file);

// Throw InputError. error: of errno; MachineError where it says that the disk is full or broken.
[[noreturn]] void RefuseOutput(const std::filesystem::path& path, const std::string& what, int error);
[[noreturn]] void RefuseOutput(const std::filesystem::path& path, const std::string& expected, const std::string& got);

}  // namespace merlin
