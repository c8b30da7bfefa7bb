// Broken texts for tests of readers: cut, overwritten, shuffled and repeated, from a fixed seed.
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace merlin {

class Mutator {
 public:
  explicit Mutator(unsigned seed) : generator_(seed) {}

  // The text with one to four faults.
  std::string Mutated(std::string text) {
    for (std::size_t faults = 1 + Below(4); faults > 0; --faults) Mutate(text);
    return text;
  }

 private:
  std::size_t Below(std::size_t limit) { return limit == 0 ? 0 : generator_() % limit; }

  void Mutate(std::string& text) {
    static const std::vector<std::string_view> kWords{"nan",
                                                      "inf",
                                                      "-1",
                                                      "0",
                                                      "1e308",
                                                      "-1e-320",
                                                      "9223372036854775807",
                                                      "99999999999999999999",
                                                      "FIX",
                                                      "#",
                                                      "\n",
                                                      "\r\n",
                                                      "\t",
                                                      "1 ",
                                                      "0x1p3",
                                                      "--3",
                                                      "+",
                                                      ".",
                                                      "1e",
                                                      "\xff"};
    const std::size_t at = Below(text.size() + 1), length = Below(30);
    switch (Below(6)) {
      case 0:
        return text.resize(at);
      case 1:
        return void(text.erase(at, length));
      case 2:
        return void(text.insert(at, text.substr(Below(text.size() + 1), length)));
      case 3:
        return void(text.insert(at, kWords[Below(kWords.size())]));
      case 4:
        return void(text.replace(at, length, kWords[Below(kWords.size())]));
      default:
        if (at < text.size()) text[at] = static_cast<char>(generator_());
    }
  }

  std::mt19937 generator_;
};

}  // namespace merlin
