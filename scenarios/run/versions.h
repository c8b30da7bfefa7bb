// Names and versions of this program and of the libraries that every build of it links, for result.json.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace merlin {

std::vector<std::pair<std::string, std::string>> Versions();

}  // namespace merlin
