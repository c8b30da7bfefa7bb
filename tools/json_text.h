// What --json prints: one document, whatever names and messages of other programs are in it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace merlin {

// Indented, with its line end; bytes that are no UTF-8 become U+FFFD, numbers that are not finite null.
inline std::string JsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace merlin
