// Helpers for targets that read texts.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/text_fields.h"
#include "tests/fuzz/target.h"

namespace merlin::fuzz {

inline Bytes ToBytes(std::string_view text) { return Bytes(text.begin(), text.end()); }

inline std::string_view ToText(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Fragments that often break readers, as seeds: the driver inserts seeds into one another.
inline void AddWords(std::vector<Bytes>& seeds) {
  for (const char* word : {"nan", "inf", "-1", "0", "1e308", "1e-320", "-", "99999999999999999999", "\n", " ", "#"})
    seeds.push_back(ToBytes(word));
}

// The reader's result; none if it rejects the text. Each line of its message must then begin with the name of the file.
template <class Parse>
auto TakenOrRefused(Parse parse, std::string_view text) -> std::optional<decltype(parse(text, std::string()))> {
  try {
    return parse(text, std::string("f.txt"));
  } catch (const InputError& error) {
    const std::string_view what = error.what();
    Expect(!what.empty() && !what.ends_with('\n'), "a refusal says something");
    ForEachLine(what, [](std::string_view line, std::size_t) {
      Expect(line.starts_with("f.txt"), "each line of a refusal names the file");
    });
    return std::nullopt;
  }
}

}  // namespace merlin::fuzz
