// Names and versions of the libraries that only the twin links, for result.json.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace merlin {

std::vector<std::pair<std::string, std::string>> TwinVersions();

}  // namespace merlin
