// Of this program and what it links, for result.json and doctor.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace merlin {

std::vector<std::pair<std::string, std::string>> Versions();

}  // namespace merlin
