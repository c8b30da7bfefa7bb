// A text file that a user names, whole.
#pragma once

#include <fstream>
#include <ios>
#include <string>

#include "robot/base/error.h"

namespace merlin {

// Throws InputError for a file that cannot be read, or that goes on beyond 1 GB (a device); what: "a pose graph (g2o)".
inline std::string ReadFile(const std::string& file, const std::string& what) {
  constexpr std::size_t kMost_bytes = 1'000'000'000;
  std::ifstream in(file, std::ios::binary);
  std::string text, part(1 << 20, '\0');
  if (!in) throw InputError(file, "cannot be read", what);
  while (in.read(part.data(), static_cast<std::streamsize>(part.size())), in.gcount() > 0) {
    text.append(part, 0, static_cast<std::size_t>(in.gcount()));
    if (text.size() > kMost_bytes) throw InputError(file, "longer than 1 GB", what);
  }
  if (!in.eof()) throw InputError(file, "cannot be read", what);
  return text;
}

}  // namespace merlin
