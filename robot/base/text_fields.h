// Splits a line of a text file into fields at blanks, and checks each field as it is read. Every reader of such files
// uses it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace merlin {

// The text without the byte-order mark that some editors put before UTF-8. Every reader of a text file ignores the mark
// through this function, or through a library that does (yaml-cpp, MuJoCo's XML reader).
constexpr std::string_view WithoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

// Calls each(line, number) for every line of a text. Numbers start at 1. Line ends ("\n" or "\r\n") and a byte-order
// mark at the start of the text are removed.
template <class Each>
void ForEachLine(std::string_view text, Each each) {
  text = WithoutByteOrderMark(text);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    each(line, number);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

// A field for an error message: in quotes, shortened if it is long, without control characters and bytes that are not
// ASCII.
std::string Quoted(std::string_view field);

// A number for a message, with up to six digits: "0.25", "1e+07".
std::string NumberText(double number);

// "line 4", "lines 4, 7, 9", for a warning. Names at most the first dozen.
std::string LinesOf(const std::vector<std::size_t>& lines);

class TextFields {
 public:
  // file and number: named in errors. The line must outlive this object.
  TextFields(std::string_view line, std::string_view file, std::size_t number)
      : rest_(line), file_(file), number_(number) {}

  // The next field; empty at the line's end.
  std::string_view Word();

  // The next field as a finite number of at most that magnitude, or as a whole number. Throws InputError. what: the
  // field's name.
  double Number(std::string_view what, double size_max);
  std::int64_t Whole(std::string_view what);

  bool AtEnd() const;
  void RequireEnd(std::string_view what);  // throws InputError if fields are left; what: the line's name

  std::string where() const { return std::string(file_) + ":" + std::to_string(number_); }

 private:
  std::string_view Required(std::string_view what);

  std::string_view rest_;
  std::string_view file_;
  std::size_t number_;
};

}  // namespace merlin
