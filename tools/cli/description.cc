#include "tools/cli/description.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>

namespace merlin::cli {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view Trimmed(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(kBlanks), line.size());
  line.remove_prefix(begin);
  return line.substr(0, line.find_last_not_of(kBlanks) + 1);
}

std::string_view TakeLine(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return Trimmed(line);
}

// Removes marks that only form a frame: "# ---", "## Title ##".
std::string_view WithoutFrame(std::string_view line) {
  constexpr std::string_view kFrame = "#*=-~_ ";
  if (line.find_first_not_of(kFrame) == std::string_view::npos) return "";
  line.remove_prefix(std::min(line.find_first_not_of("#* "), line.size()));
  return line.substr(0, line.find_last_not_of("#* ") + 1);
}

// Appends a line of the comment. False if the paragraph has ended.
bool Append(std::string& paragraph, std::string_view line) {
  if (line.empty()) return paragraph.empty();
  paragraph.append(paragraph.empty() ? "" : " ").append(line);
  return true;
}

// The first paragraph of the '#' lines at the start of a YAML file.
std::string YamlParagraph(std::string_view text) {
  std::string paragraph;
  while (!text.empty()) {
    const std::string_view line = TakeLine(text);
    if (line.starts_with('#')) {
      if (!Append(paragraph, WithoutFrame(line))) break;
    } else if (!paragraph.empty() || !(line.empty() || line.starts_with('%') || line == "---")) {
      break;
    }
  }
  return paragraph;
}

// The first paragraph of the comment at the start of an XML file, before its root element or directly inside it.
std::string XmlParagraph(std::string_view text) {
  constexpr std::string_view kOpen = "<!--", kClose = "-->";
  bool in_root = false;
  for (text = text.substr(text.find('<')); !text.starts_with(kOpen);) {
    const bool is_prolog = text.starts_with("<?") || text.starts_with("<!");
    const std::size_t end = text.find('>');
    if (end == std::string_view::npos || (in_root && !is_prolog)) return "";
    in_root = in_root || !is_prolog;
    text.remove_prefix(end);
    text.remove_prefix(std::min(text.find('<'), text.size()));
  }
  text.remove_prefix(kOpen.size());
  text = text.substr(0, text.find(kClose));
  std::string paragraph;
  while (!text.empty() && Append(paragraph, WithoutFrame(TakeLine(text)))) continue;
  return paragraph;
}

// Whether the full stop after a word marks an abbreviation: "e.g.", "No.", "Dr.".
bool IsShortened(std::string_view word) {
  constexpr std::string_view kShortened[] = {"approx", "bzw", "ca", "cf", "Dr", "Eq",   "Fig", "incl", "inkl",
                                             "Mr",     "Mrs", "Ms", "No", "Nr", "Prof", "St",  "vs"};
  while (!word.empty() && (word.front() == '(' || word.front() == '"')) word.remove_prefix(1);
  const bool has_letter = std::ranges::any_of(word, [](unsigned char c) { return std::isalpha(c) != 0; });
  return (has_letter && word.find('.') != std::string_view::npos && word.size() < 6) ||
         std::ranges::find(kShortened, word) != std::end(kShortened);
}

// The length of the text up to the end of the sentence, if this mark ends it; none otherwise ("2.0", "No. 5").
std::optional<std::size_t> SentenceEnd(std::string_view text, std::size_t mark) {
  const std::size_t end = std::min(text.find_first_not_of(".!?\"')", mark), text.size());
  if (end == text.size()) return end;
  if (text[end] != ' ') return std::nullopt;
  if (text[mark] != '.') return end;
  const std::size_t word = text.rfind(' ', mark) + 1;  // 0 where there is no blank before it
  const auto next = static_cast<unsigned char>(text[std::min(text.find_first_not_of(" (\"'", end), text.size() - 1)]);
  // A single letter is an initial ("z. B."), or a unit after its number ("10 m").
  const bool initial = mark - word < 2 && (word < 2 || !std::isdigit(static_cast<unsigned char>(text[word - 2])));
  const bool goes_on =
      std::islower(next) || std::isdigit(next) || initial || IsShortened(text.substr(word, mark - word));
  return goes_on ? std::nullopt : std::optional(end);
}

}  // namespace

std::string FirstSentence(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte-order mark
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return "";
  const std::string paragraph = text[begin] == '<' ? XmlParagraph(text) : YamlParagraph(text);
  for (std::size_t stop = 0; (stop = paragraph.find_first_of(".!?", stop)) != std::string::npos; ++stop)
    if (const auto end = SentenceEnd(paragraph, stop)) return paragraph.substr(0, *end);
  return paragraph;
}

}  // namespace merlin::cli
