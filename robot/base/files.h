// Files as wholes: read whole, and written whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace merlin {

// Throws InputError for a file that cannot be read or is longer than 1 GB (a device never ends); what: "a pose graph
// (g2o)".
std::string ReadFile(const std::filesystem::path& file, const std::string& what);

// Writes the file whole or not at all: into "<file>.part" first, then renamed. Throws MachineError (disk full, no
// permission), and leaves no ".part" behind.
void WriteFile(const std::filesystem::path& file, std::string_view bytes);

}  // namespace merlin
