// Splits the text of cloud files into lines, words and numbers.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/base/text_fields.h"

namespace merlin::cloud_text {

// Gives the lines one by one, without their line ends (\n or \r\n); counts from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  // For a whole file: skips a byte-order mark.
  static Lines OfFile(std::string_view bytes) {
    Lines lines(bytes);
    lines.at_ = bytes.size() - WithoutByteOrderMark(bytes).size();
    return lines;
  }
  std::optional<std::string_view> Next() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = std::min(end + 1, text_.size());
    ++number_;
    return line;
  }
  std::size_t number() const { return number_; }  // of the line given last
  std::size_t at() const { return at_; }          // byte at which the next line begins
  std::string_view Rest() const { return text_.substr(at_); }

 private:
  std::string_view text_;
  std::size_t at_ = 0, number_ = 0;
};

constexpr std::string_view kBlanks = " \t\v\f\r";

inline std::string_view Trim(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  const std::size_t end = text.find_last_not_of(kBlanks);
  return end == std::string_view::npos ? std::string_view{} : text.substr(begin, end + 1 - begin);
}

// Writes into `words`, so that its memory can be used again for the next line.
inline void SplitWords(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
}

// A separator inside a field in "quotes" does not count.
inline void SplitAt(char separator, std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = std::min(line.find(separator, begin), line.size());
    if (Trim(line.substr(begin, end - begin)).starts_with('"')) {
      const std::size_t closing = line.find('"', line.find('"', begin) + 1);
      if (closing != std::string_view::npos) end = std::min(line.find(separator, closing), line.size());
    }
    fields.push_back(Trim(line.substr(begin, end - begin)));
    begin = end + 1;
  }
}

inline std::string_view WithoutQuotes(std::string_view field) {
  return field.size() >= 2 && field.front() == '"' && field.back() == '"' ? Trim(field.substr(1, field.size() - 2))
                                                                          : field;
}

// The number that the whole text is; none if it is not one. nan and inf count as numbers.
template <class Number>
std::optional<Number> ToNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace merlin::cloud_text
