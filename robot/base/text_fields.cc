#include "robot/base/text_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r";

// from_chars takes no "+", which printf's "%+f" writes.
std::string_view WithoutPlus(std::string_view field) {
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  return field;
}

template <class Value>
bool Parse(std::string_view field, Value& value) {
  field = WithoutPlus(field);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size();
}

}  // namespace

std::string Quoted(std::string_view field) {
  constexpr std::size_t kLongest = 40;
  std::string shown = "'";
  for (const char c : field.substr(0, kLongest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (field.size() > kLongest ? "...'" : "'");
}

std::string NumberText(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string LinesOf(const std::vector<std::size_t>& lines) {
  constexpr std::size_t kMost = 12;
  std::string text = lines.size() == 1 ? "line " : "lines ";
  for (std::size_t i = 0; i < std::min(kMost, lines.size()); ++i) text += (i ? ", " : "") + std::to_string(lines[i]);
  return lines.size() > kMost ? text + " and more" : text;
}

std::string_view TextFields::Word() {
  const std::size_t begin = rest_.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return rest_ = {};
  rest_.remove_prefix(begin);
  const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
  rest_.remove_prefix(word.size());
  return word;
}

bool TextFields::AtEnd() const { return rest_.find_first_not_of(kBlanks) == std::string_view::npos; }

std::string_view TextFields::Required(std::string_view what) {
  if (AtEnd()) throw InputError(where(), "the line ends before " + std::string(what));
  return Word();
}

double TextFields::Number(std::string_view what, double size_max) {
  const std::string_view field = Required(what);
  double value = 0.0;
  if (Parse(field, value) && std::abs(value) <= size_max) return value;
  std::ostringstream limit;
  limit << size_max;
  throw InputError(where(), std::string(what), "a number between -" + limit.str() + " and " + limit.str(),
                   Quoted(field));
}

std::int64_t TextFields::Whole(std::string_view what) {
  const std::string_view field = Required(what);
  std::int64_t value = 0;
  if (!Parse(field, value)) throw InputError(where(), std::string(what), "a whole number", Quoted(field));
  return value;
}

void TextFields::RequireEnd(std::string_view what) {
  if (!AtEnd()) throw InputError(where(), "more fields than " + std::string(what) + " has", "", Quoted(Word()));
}

}  // namespace merlin
