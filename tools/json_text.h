// Formats the output of --json: one valid document, whatever bytes are in names and messages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace merlin {

// Indented text with a line end. Invalid UTF-8 becomes U+FFFD; numbers that are not finite become null.
inline std::string JsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace merlin
