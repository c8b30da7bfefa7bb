#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "tools/cloud/cloud_file.h"
#include "tools/cloud/columns.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

using namespace cloud_text;

constexpr std::string_view kUsualNames[] = {"x", "y", "z"};

void Split(char separator, std::string_view line, std::vector<std::string_view>& fields) {
  separator == ' ' ? SplitWords(line, fields) : SplitAt(separator, line, fields);
  std::ranges::transform(fields, fields.begin(), WithoutQuotes);
}

// A number with a decimal comma, such as "1,5".
std::optional<double> ToNumberWithComma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || text.find('.') != std::string_view::npos) return std::nullopt;
  if (comma + 1 == text.size() || !std::isdigit(static_cast<unsigned char>(text[comma + 1]))) return std::nullopt;
  std::string with_point(text);
  with_point[comma] = '.';
  return ToNumber<double>(with_point);
}

// The character that separates the fields: a semicolon, a tab, a comma, or ' ' for any blanks. Tabs separate if they
// split the line into three or more. Commas do not if every word between blanks is a number, some with a decimal comma.
char SeparatorOf(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  std::vector<std::string_view> fields;
  SplitAt('\t', line, fields);
  if (fields.size() >= 3 && !fields.front().ends_with(',')) return '\t';
  if (line.find(',') == std::string_view::npos) return ' ';
  SplitWords(line, fields);
  const bool decimal = fields.size() >= 3 && std::ranges::all_of(fields, [](std::string_view field) {
                         return ToNumber<double>(field) || ToNumberWithComma(field);
                       });
  return decimal ? ' ' : ',';
}

bool IsMissing(std::string_view field) {
  for (const std::string_view word : {"", "null", "NULL", "NA", "N/A", "n/a", "None", "none"})
    if (field == word) return true;
  return false;
}

class CsvReader {
 public:
  explicit CsvReader(const std::string& name) : name_(name), faults_(name) {}

  CloudFile Read(std::string_view bytes) {
    Lines lines = Lines::OfFile(bytes);
    while (const auto line = lines.Next()) {
      line_ = lines.number();
      const std::string_view text = Trim(*line);
      if (text.empty()) continue;
      if (text.starts_with('#') || text.starts_with("//") || text.starts_with('%')) {
        ReadRemark(text);
      } else if (!IsCount(text)) {
        if (!columns_ && ReadHeader(*line)) continue;
        // A tab after the last cell separates an empty one; so does one before the first, if there is a header.
        const std::string_view row = names_line_ != 0 ? *line : line->substr(line->find(text.front()));
        if (!columns_) Begin(row);
        ++rows_;
        faults_.Try([&] { ReadRow(row); });
      }
    }
    faults_.ThrowIfAny();
    if (!columns_ && names_.empty()) throw InputError(name_, "no points in it", "lines of x, y, z");
    if (declared_ && rows_ != *declared_)
      throw InputError(Where(), rows_ < *declared_ ? "the file ends early" : "more points than the file says",
                       std::to_string(*declared_) + " points", std::to_string(rows_));
    if (columns_) columns_->GiveColours(file_, std::nullopt);
    if (decimal_commas_) file_.warnings.push_back(name_ + ": commas in its numbers are taken for decimal points");
    return std::move(file_);
  }

 private:
  std::string Where() const { return name_ + ":" + std::to_string(line_); }

  // "//X Y Z" of CloudCompare, "# x y z" of numpy may be the names of the columns. The first point shows whether they
  // are.
  void ReadRemark(std::string_view text) {
    if (columns_ || !names_.empty()) return;
    text = Trim(text.substr(std::min(text.find_first_not_of("#/%"), text.size())));
    std::vector<std::string_view> names;
    Split(SeparatorOf(text), text, names);
    if (HaveCoordinates(names)) remark_names_ = names;
  }

  // A line with a single whole number, before the points or between them, is a count of points (.pts, .xyz).
  bool IsCount(std::string_view text) {
    if (declared_ ? rows_ != *declared_ || !columns_ : columns_.has_value()) return false;
    const auto count = ToNumber<std::size_t>(text);
    if (count) declared_ = declared_.value_or(0) + *count;
    return count.has_value();
  }

  // Whether the line has the names of the columns.
  bool ReadHeader(std::string_view text) {
    if (!names_.empty()) return false;
    std::vector<std::string_view> names;
    Split(SeparatorOf(text), text, names);
    const auto first = std::ranges::find_if_not(names, &std::string_view::empty);
    if (first == names.end() || ToNumber<double>(*first) || ToNumberWithComma(*first)) return false;
    const Columns sound(names, Where());  // throws if the names are not valid
    names_ = names;
    names_line_ = line_;
    return true;
  }

  // Called at the first point.
  void Begin(std::string_view text) {
    separator_ = SeparatorOf(text);
    Split(separator_, text, fields_);
    while (fields_.size() > 3 && fields_.back().empty()) fields_.pop_back();
    if (names_.empty() && remark_names_.size() == fields_.size()) names_ = remark_names_;
    if (names_.empty()) {
      names_.resize(fields_.size());
      std::ranges::copy_n(kUsualNames, std::min<std::ptrdiff_t>(3, std::ssize(names_)), names_.begin());
    }
    columns_.emplace(names_, name_ + ":" + std::to_string(names_line_ ? names_line_ : line_));
    row_.resize(names_.size());
    fewest_ = names_.size();
    while (fewest_ > 0 && names_[fewest_ - 1].empty() && names_line_ != 0) --fewest_;
  }

  void ReadRow(std::string_view text) {
    Split(separator_, text, fields_);
    while (fields_.size() > row_.size() && fields_.back().empty()) fields_.pop_back();
    if (fields_.size() < fewest_ || fields_.size() > row_.size())
      throw InputError(Where(), "another number of columns than before", std::to_string(row_.size()),
                       std::to_string(fields_.size()));
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (columns_->Used(i)) row_[i] = Number(fields_[i]);
    columns_->Add(row_, file_);
  }

  double Number(std::string_view field) {
    if (const auto number = ToNumber<double>(field)) return *number;
    if (IsMissing(field)) return std::nan("");
    const auto number = separator_ == ',' ? std::nullopt : ToNumberWithComma(field);
    if (!number) throw InputError(Where(), "no number", "", Quoted(field));
    decimal_commas_ = true;
    return *number;
  }

  const std::string& name_;
  FaultList faults_;
  CloudFile file_;
  std::size_t line_ = 0, names_line_ = 0, rows_ = 0, fewest_ = 0;
  std::optional<std::size_t> declared_;
  char separator_ = 0;
  std::vector<std::string_view> names_, remark_names_, fields_;
  std::optional<Columns> columns_;
  std::vector<double> row_;
  bool decimal_commas_ = false;
};

}  // namespace

CloudFile ParseCsv(std::string_view bytes, const std::string& name) { return CsvReader(name).Read(bytes); }

}  // namespace merlin
