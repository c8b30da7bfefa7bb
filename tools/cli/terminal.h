// Fits text to the terminal. Widths are counted in columns: an umlaut takes one, a Chinese character two, a combining accent
// none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin::cli {

// The present width of the terminal, which may change at any time. If the terminal does not say: the environment variable
// COLUMNS, or else 80. 0 if fd is not a terminal.
int TerminalColumns(int fd);

int DisplayColumns(std::string_view text);

// As much of the text as fits into that many columns. Control characters and bytes that are not UTF-8 become '?'.
std::string Cut(std::string_view text, int columns);

// The text as lines of at most that many columns, broken at blanks; a longer word gets its own line. 0: one single line.
std::vector<std::string> Wrap(std::string_view text, int columns);

// Shows progress on stderr: on a terminal as one line that is overwritten and never wraps, elsewhere as plain lines.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  // clears the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool on_terminal() const { return on_terminal_; }
  void Show(std::string_view text);
  void Keep();  // leaves the present line as it is and goes on below it

 private:
  bool on_terminal_;
};

}  // namespace merlin::cli
