// Text that fits the terminal, counted in columns: an umlaut takes one, a Chinese character two, an accent by itself none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace merlin::cli {

// The terminal's width now: it may be resized at any time. COLUMNS where the terminal does not tell, else 80; 0 where fd
// is no terminal.
int TerminalColumns(int fd);

int DisplayColumns(std::string_view text);

// As much of the text as fits into so many columns. In place of control characters and bytes that are no UTF-8 stands '?'.
std::string Cut(std::string_view text, int columns);

// The text in lines of at most so many columns, broken at blanks; a longer word keeps a line of its own. 0: one line.
std::vector<std::string> Wrap(std::string_view text, int columns);

// What is going on: on a terminal one line that renews itself and never wraps, elsewhere plain lines. To stderr.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  // clears the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool on_terminal() const { return on_terminal_; }
  void Show(std::string_view text);
  void Keep();  // what stands there stays: the next goes below it

 private:
  bool on_terminal_;
};

}  // namespace merlin::cli
