#include <cmath>
#include <map>
#include <utility>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "tools/cloud/cloud_file.h"
#include "tools/cloud/columns.h"
#include "tools/cloud/scalar.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

using namespace cloud_text;

struct Property {
  std::string name;
  Scalar type = Scalar::kFloat;
  std::optional<Scalar> count_type{};  // only of a list
};

struct Element {
  std::string name, where;
  std::size_t count = 0;
  std::vector<Property> properties{};
};

struct Header {
  std::string name, format{};
  std::vector<Element> elements{};
  std::size_t lines = 0, data_at = 0;
};

Scalar TypeOf(const std::string& where, std::string_view word) {
  static const std::map<std::string, Scalar, std::less<>> kTypes{
      {"char", Scalar::kInt8},     {"int8", Scalar::kInt8},     {"uchar", Scalar::kUint8},
      {"uint8", Scalar::kUint8},   {"short", Scalar::kInt16},   {"int16", Scalar::kInt16},
      {"ushort", Scalar::kUint16}, {"uint16", Scalar::kUint16}, {"int", Scalar::kInt32},
      {"int32", Scalar::kInt32},   {"uint", Scalar::kUint32},   {"uint32", Scalar::kUint32},
      {"float", Scalar::kFloat},   {"float32", Scalar::kFloat}, {"double", Scalar::kDouble},
      {"float64", Scalar::kDouble}};
  const auto found = kTypes.find(word);
  if (found == kTypes.end())
    throw InputError(where, "no such type", "char, uchar, short, ushort, int, uint, float or double", Quoted(word));
  return found->second;
}

Property ReadProperty(const std::vector<std::string_view>& words, const std::string& where) {
  if (words.size() == 3) return {std::string(words[2]), TypeOf(where, words[1])};
  if (words.size() != 5 || words[1] != "list")
    throw InputError(where, "no property", "property TYPE NAME or property list TYPE TYPE NAME");
  const Scalar count_type = TypeOf(where, words[2]);
  if (count_type == Scalar::kFloat || count_type == Scalar::kDouble)
    throw InputError(where, "a list's length is a whole number", "an integer type", Quoted(words[2]));
  return {std::string(words[4]), TypeOf(where, words[3]), count_type};
}

Element ReadElement(const std::vector<std::string_view>& words, const std::string& where) {
  const auto count = words.size() == 3 ? ToNumber<std::size_t>(words[2]) : std::nullopt;
  if (!count) throw InputError(where, "no element", "element NAME COUNT");
  return {std::string(words[1]), where, *count};
}

// False at the end of the header.
bool ReadHeaderLine(const std::vector<std::string_view>& words, const std::string& where, Header& header) {
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return true;
  if (words[0] == "end_header") return false;
  if (words[0] == "format" && words.size() == 3 && words[2] == "1.0" && header.format.empty()) {
    header.format = words[1];
    if (header.format != "ascii" && header.format != "binary_little_endian" && header.format != "binary_big_endian")
      throw InputError(where, "no such format", "ascii, binary_little_endian or binary_big_endian", Quoted(words[1]));
  } else if (words[0] == "element") {
    header.elements.emplace_back();  // also if this line is rejected, because the properties after it belong to it
    header.elements.back() = ReadElement(words, where);
  } else if (words[0] == "property" && !header.elements.empty()) {
    header.elements.back().properties.push_back(ReadProperty(words, where));
  } else {
    throw InputError(where, "not a line of a PLY header", "format, element, property, comment or end_header",
                     Quoted(words[0]));
  }
  return true;
}

Header ReadHeader(std::string_view bytes, const std::string& name) {
  Lines lines = Lines::OfFile(bytes);
  if (lines.Next() != "ply") throw InputError(name + ":1", "not a PLY file", "ply");
  Header header{.name = name};
  FaultList faults(name);
  std::vector<std::string_view> words;
  while (const auto line = lines.Next()) {
    SplitWords(*line, words);
    bool more = true;
    faults.Try([&] { more = ReadHeaderLine(words, name + ":" + std::to_string(lines.number()), header); });
    if (more) continue;
    faults.ThrowIfAny();
    if (header.format.empty()) throw InputError(name, "the header has no line format");
    header.lines = lines.number();
    header.data_at = lines.at();
    return header;
  }
  faults.ThrowIfAny();
  throw InputError(name, "the header does not end", "end_header");
}

// Reads the rows of the elements one after the other: one value per property, NaN for a list.
class Rows {
 public:
  virtual ~Rows() = default;
  virtual std::size_t Left() const = 0;                           // bytes left
  virtual std::size_t Least(const Property& property) const = 0;  // least number of bytes that it takes
  virtual void Read(const Element& element, std::vector<double>& row) = 0;
  virtual bool CanGoOn() const = 0;  // whether reading can continue with the next row after one that was rejected
  virtual std::size_t Finish() = 0;  // number of bytes after the data, which the format does not use
};

class TextRows : public Rows {
 public:
  TextRows(std::string_view data, const Header& header) : lines_(data), header_(header) {}
  std::size_t Left() const override { return lines_.Rest().size() + 1; }  // the last line may have no line end
  std::size_t Least(const Property&) const override { return 2; }

  void Read(const Element& element, std::vector<double>& row) override {
    NextLine();
    ended_ = words_.empty();
    if (ended_) throw InputError(Where(), "the file ends early", "another " + Quoted(element.name));
    std::size_t at = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = Number(at++);
      if (!element.properties[i].count_type) continue;
      if (!(row[i] >= 0.0 && row[i] <= static_cast<double>(words_.size() - at)))
        throw InputError(Where(), "a list of another length than it says");
      at += static_cast<std::size_t>(row[i]);
      row[i] = std::nan("");
    }
    if (at != words_.size())
      throw InputError(Where(), "another number of values than properties", std::to_string(at),
                       std::to_string(words_.size()));
  }
  bool CanGoOn() const override { return !ended_; }
  std::size_t Finish() override {
    NextLine();
    if (!words_.empty()) throw InputError(Where(), "more data than the header says");
    return 0;
  }

 private:
  std::string Where() const { return header_.name + ":" + std::to_string(header_.lines + lines_.number()); }
  void NextLine() {
    words_.clear();
    while (words_.empty()) {
      const auto line = lines_.Next();
      if (!line) return;
      SplitWords(*line, words_);
    }
  }
  double Number(std::size_t at) const {
    if (at >= words_.size()) throw InputError(Where(), "fewer values than properties");
    const auto number = ToNumber<double>(words_[at]);
    if (!number) throw InputError(Where(), "no number", "", Quoted(words_[at]));
    return *number;
  }

  Lines lines_;
  const Header& header_;
  std::vector<std::string_view> words_;
  bool ended_ = false;
};

class BinaryRows : public Rows {
 public:
  explicit BinaryRows(BinaryReader reader) : reader_(std::move(reader)) {}
  std::size_t Left() const override { return reader_.left(); }
  std::size_t Least(const Property& property) const override {
    return SizeOf(property.count_type.value_or(property.type));
  }

  void Read(const Element& element, std::vector<double>& row) override {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Property& property = element.properties[i];
      row[i] = reader_.Read(property.count_type.value_or(property.type));
      if (!property.count_type) continue;
      if (row[i] < 0.0) throw InputError(reader_.Where(), "a list of negative length");
      reader_.Skip(static_cast<std::size_t>(row[i]), SizeOf(property.type));
      row[i] = std::nan("");
    }
  }
  bool CanGoOn() const override { return false; }
  std::size_t Finish() override { return reader_.left(); }

 private:
  BinaryReader reader_;
};

// The file must be large enough for what the header claims, before memory is reserved for it.
void CheckCount(const Element& element, const Rows& rows) {
  std::size_t least = 0;
  for (const Property& property : element.properties) least += rows.Least(property);
  if (element.count > 0 && (least == 0 || element.count > rows.Left() / least))
    throw InputError(
        element.where, "so many are not in the file",
        std::to_string(element.count) + " " + Quoted(element.name) + " of at least " + std::to_string(least) + " bytes",
        std::to_string(rows.Left()) + " bytes");
}

CloudFile ReadElements(const Header& header, Rows& rows) {
  CloudFile file;
  FaultList faults(header.name);
  bool found = false;
  for (const Element& element : header.elements) {
    CheckCount(element, rows);
    std::optional<Columns> columns;
    std::optional<bool> whole_colours;
    if (element.name == "vertex") {
      if (std::exchange(found, true)) throw InputError(element.where, "the element 'vertex' is there twice");
      std::vector<std::string_view> names;
      for (const Property& property : element.properties)
        names.push_back(property.count_type ? "" : std::string_view(property.name));
      columns.emplace(names, element.where);
      if (const auto colour = columns->colour()) whole_colours = IsWhole(element.properties[*colour].type);
      file.cloud.positions.reserve(element.count);
    }
    std::vector<double> row(element.properties.size());
    for (std::size_t i = 0; i < element.count; ++i) {
      const bool read = faults.Try([&] { rows.Read(element, row); });
      if (!read && !rows.CanGoOn()) faults.ThrowIfAny();
      if (read && columns) columns->Add(row, file);
    }
    if (columns) columns->GiveColours(file, whole_colours);
  }
  faults.Try([&] {
    if (const std::size_t more = rows.Finish(); more > 0) file.warnings.push_back(BytesBehind(header.name, more));
  });
  faults.ThrowIfAny();
  if (!found) throw InputError(header.name, "no points in it", "an element 'vertex'");
  return file;
}

}  // namespace

CloudFile ParsePly(std::string_view bytes, const std::string& name) {
  const Header header = ReadHeader(bytes, name);
  const std::string_view data = bytes.substr(header.data_at);
  if (header.format == "ascii") {
    TextRows rows(data, header);
    return ReadElements(header, rows);
  }
  const std::endian order = header.format == "binary_big_endian" ? std::endian::big : std::endian::little;
  BinaryRows rows({data, order, header.data_at, name});
  return ReadElements(header, rows);
}

}  // namespace merlin
