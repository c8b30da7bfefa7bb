// The known name that a mistyped one most likely meant, for error messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

namespace merlin {

// Fewest inserted, deleted and replaced characters (Levenshtein 1966); the first of equals; empty if none are known.
template <std::ranges::input_range Names>
std::string NearestName(std::string_view name, const Names& known) {
  const auto distance = [name](std::string_view other) {
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < name.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < other.size(); ++j) {
        const std::size_t replaced = diagonal + (name[i] == other[j] ? 0 : 1);
        diagonal = row[j + 1];
        row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
      }
    }
    return row.back();
  };
  const auto nearest = std::ranges::min_element(known, {}, distance);
  return nearest == std::ranges::end(known) ? std::string() : std::string(*nearest);
}

}  // namespace merlin
