// Real data stored beside the project. Tests that need it are skipped by name if it is missing.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace merlin {

inline std::filesystem::path SharedData(const std::string& folder) {
  const char* const variable = std::getenv("MERLIN_SHARED_DATA");
  const std::filesystem::path data =
      variable ? std::filesystem::path(variable) : std::filesystem::path(MERLIN_SOURCE_DIR) / "../shared/data";
  return data / folder;
}

}  // namespace merlin
