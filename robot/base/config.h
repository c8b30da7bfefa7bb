// What every XConfig shares. A config is a plain struct with its defaults in place and, beside it, one function
//   template <class Visitor> void Visit(Visitor& v, XConfig& c) { v("speed_m_s", c.speed_m_s, Range{0.0, 2.0}); ... }
// that names each field and its rule. Reading YAML, writing it back, --set and Validate are all visitors over it.
#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace merlin {

// Closed interval a number must lie in; NaN lies in none.
struct Range {
  double min = -HUGE_VAL;
  double max = HUGE_VAL;
};

struct Fault {
  std::string field;  // dotted path: "pilot.speed_m_s"
  std::string value;
  std::string rule;  // "in [0, 2]"
};

namespace detail {

inline std::string Text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

struct Checker {
  std::vector<Fault> faults;
  std::string prefix;

  template <class T>
  void operator()(const char* key, T& value, Range range = {}) {
    if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>) {
      const std::string outer = prefix;
      prefix += std::string(key) + ".";
      Visit(*this, value);
      prefix = outer;
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const double number = static_cast<double>(value);
      if (!(number >= range.min && number <= range.max) || !std::isfinite(number))
        faults.push_back({prefix + key, Text(number), "in [" + Text(range.min) + ", " + Text(range.max) + "]"});
    }
  }
};

}  // namespace detail

// All fields that break their rule. Empty: the config is valid.
template <class Config>
std::vector<Fault> Validate(Config config) {
  detail::Checker checker;
  Visit(checker, config);
  return checker.faults;
}

}  // namespace merlin
