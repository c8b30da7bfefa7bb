#include "tools/cli/terminal.h"

#include <fmt/core.h>
#include <locale.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <wchar.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "robot/base/utf8.h"

namespace merlin::cli {
namespace {

constexpr int kUsualColumns = 80;

// Widths from the C library's table, independent of the user's locale; negative for control characters.
int ColumnsOf(char32_t code) {
  static const locale_t utf8 = newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
  if (code < 0x20 || code == 0x7F) return -1;
  if (code < 0x7F || utf8 == nullptr) return 1;
  const locale_t before = uselocale(utf8);
  const int columns = wcwidth(static_cast<wchar_t>(code));
  uselocale(before);
  return columns;
}

// each(bytes to show, columns) for every character.
template <class Each>
void ForEachCharacter(std::string_view text, Each each) {
  while (!text.empty()) {
    const Utf8Character first = FirstCharacter(text);
    const int columns = first.valid ? ColumnsOf(first.code) : -1;
    if (columns < 0)
      each(std::string_view("?"), 1);
    else
      each(text.substr(0, first.bytes), columns);
    text.remove_prefix(first.bytes);
  }
}

}  // namespace

int TerminalColumns(int fd) {
  if (isatty(fd) != 1) return 0;
  winsize size{};
  if (ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* columns = std::getenv("COLUMNS");
  const int told = columns == nullptr ? 0 : std::atoi(columns);
  return told > 0 ? told : kUsualColumns;
}

int DisplayColumns(std::string_view text) {
  int sum = 0;
  ForEachCharacter(text, [&sum](std::string_view, int columns) { sum += columns; });
  return sum;
}

std::string Cut(std::string_view text, int columns) {
  std::string fits;
  int used = 0;
  ForEachCharacter(text, [&](std::string_view bytes, int width) {
    used += width;
    if (used <= columns) fits += bytes;
  });
  return fits;
}

std::vector<std::string> Wrap(std::string_view text, int columns) {
  std::vector<std::string> lines{""};
  int used = 0;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (word.empty()) continue;
    const int width = DisplayColumns(word);
    if (columns > 0 && used > 0 && used + 1 + width > columns) {
      lines.emplace_back();
      used = 0;
    }
    lines.back().append(used > 0 ? " " : "").append(Cut(word, width));
    used += width + (used > 0 ? 1 : 0);
  }
  return lines;
}

ProgressLine::ProgressLine() : on_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);  // the terminal may be gone, and a destructor must not throw
}

void ProgressLine::Show(std::string_view text) {
  // One column stays free, because some terminals move to the next line as soon as the last column is filled.
  if (on_terminal_)
    fmt::print(stderr, "\r\033[K{}", Cut(text, std::max(0, TerminalColumns(STDERR_FILENO) - 1)));
  else
    fmt::print(stderr, "{}\n", text);
  std::fflush(stderr);
}

void ProgressLine::Keep() {
  if (on_terminal_) std::fputs("\n", stderr);
}

}  // namespace merlin::cli
