// Programs that the tests compare merlin with. tools/merlin test installs them into .deps/oracles (see
// tools/setup/oracles.sh); $MERLIN_ORACLES names another environment.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace merlin {

inline std::filesystem::path OracleProgram(const std::string& name) {
  const char* const own = std::getenv("MERLIN_ORACLES");
  const std::filesystem::path folder = own && *own ? own : std::filesystem::path(MERLIN_SOURCE_DIR) / ".deps/oracles";
  return folder / "bin" / name;
}

}  // namespace merlin
