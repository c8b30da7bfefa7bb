#include <algorithm>

#include "robot/types/error.h"
#include "tools/cloud/cloud_file.h"
#include "tools/cloud/columns.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

using namespace cloud_text;

constexpr std::string_view kUsualNames[] = {"x", "y", "z"};

char SeparatorOf(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

void Split(char separator, std::string_view line, std::vector<std::string_view>& fields) {
  separator == ' ' ? SplitWords(line, fields) : SplitAt(separator, line, fields);
}

std::string_view WithoutQuotes(std::string_view field) {
  return field.size() >= 2 && field.front() == '"' && field.back() == '"' ? field.substr(1, field.size() - 2) : field;
}

}  // namespace

CloudFile ParseCsv(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);  // the mark some editors put before UTF-8
  CloudFile file;
  Lines lines(bytes);
  char separator = 0;
  std::optional<Columns> columns;
  std::vector<std::string_view> fields;
  std::vector<double> row;
  while (const auto line = lines.Next()) {
    const std::string_view text = Trim(*line);
    if (text.empty() || text.starts_with('#')) continue;
    const std::string where = name + ":" + std::to_string(lines.number());
    if (separator == 0) separator = SeparatorOf(text);
    Split(separator, text, fields);
    if (!columns) {
      const bool header = !ToNumber<double>(fields.front());
      std::vector<std::string_view> names(fields.size());
      if (header) std::ranges::transform(fields, names.begin(), WithoutQuotes);
      if (!header) std::ranges::copy_n(kUsualNames, std::min<std::ptrdiff_t>(3, std::ssize(names)), names.begin());
      columns.emplace(names, where);
      row.resize(fields.size());
      if (header) continue;
    }
    if (fields.size() != row.size())
      throw InputError(where, "another number of columns than before", std::to_string(row.size()),
                       std::to_string(fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto number = ToNumber<double>(fields[i]);
      if (!number) throw InputError(where, "no number", "", Quoted(fields[i]));
      row[i] = *number;
    }
    columns->Add(row, file);
  }
  if (!columns) throw InputError(name, "no points in it", "lines of x, y, z");
  return file;
}

}  // namespace merlin
