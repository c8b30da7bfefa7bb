#include <algorithm>
#include <limits>
#include <map>

#include "robot/types/error.h"
#include "tools/cloud/cloud_file.h"
#include "tools/cloud/columns.h"
#include "tools/cloud/scalar.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

using namespace cloud_text;

constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();

// The values of a point. A field of COUNT n is n of them, all but the first without a name.
struct Values {
  std::vector<std::string_view> names;  // of the header's words
  std::vector<Scalar> types;
};

struct Header {
  std::map<std::string, std::vector<std::string>> entries;  // keyword to its words
  std::map<std::string, std::string> where;
  std::size_t lines = 0, data_at = 0;
};

Header ReadHeader(std::string_view bytes, const std::string& name) {
  Header header;
  Lines lines(bytes);
  std::vector<std::string_view> words;
  while (const auto line = lines.Next()) {
    SplitWords(*line, words);
    if (words.empty() || words.front().starts_with('#')) continue;
    const std::string where = name + ":" + std::to_string(lines.number()), key(words.front());
    static const std::vector<std::string> kKeys{"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                                "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    if (std::ranges::find(kKeys, key) == kKeys.end())
      throw InputError(where, "not a line of a PCD header", "VERSION, FIELDS, SIZE, TYPE, ... DATA", Quoted(key));
    if (!header.entries.try_emplace(key, words.begin() + 1, words.end()).second)
      throw InputError(where, key + " is there twice");
    header.where[key] = where;
    if (key != "DATA") continue;
    header.lines = lines.number();
    header.data_at = lines.at();
    return header;
  }
  throw InputError(name, "the header does not end", "a line DATA");
}

// The words of an entry, of the given number (0: any but none).
const std::vector<std::string>& Words(const Header& header, const std::string& key, std::size_t count,
                                      const std::string& name) {
  const auto entry = header.entries.find(key);
  if (entry == header.entries.end()) throw InputError(name, "the header has no line " + key);
  if (count == 0 ? entry->second.empty() : entry->second.size() != count)
    throw InputError(header.where.at(key), key + " has another number of words",
                     count == 0 ? "some" : std::to_string(count), std::to_string(entry->second.size()));
  return entry->second;
}

std::size_t Count(const Header& header, const std::string& key, const std::string& word) {
  const auto number = ToNumber<std::size_t>(word);
  if (!number) throw InputError(header.where.at(key), key + " is no count", "a whole number", Quoted(word));
  return *number;
}

Scalar TypeOf(const std::string& where, const std::string& type, const std::string& size) {
  static const std::map<std::string, Scalar> kTypes{
      {"I1", Scalar::kInt8},  {"U1", Scalar::kUint8},  {"I2", Scalar::kInt16}, {"U2", Scalar::kUint16},
      {"I4", Scalar::kInt32}, {"U4", Scalar::kUint32}, {"I8", Scalar::kInt64}, {"U8", Scalar::kUint64},
      {"F4", Scalar::kFloat}, {"F8", Scalar::kDouble}};
  const auto found = kTypes.find(type + size);
  if (found == kTypes.end())
    throw InputError(where, "no such type", "I or U of 1, 2, 4, 8 bytes, F of 4 or 8", Quoted(type + " of " + size));
  return found->second;
}

Values ReadValues(const Header& header, std::size_t most, const std::string& name) {
  const auto& fields = Words(header, "FIELDS", 0, name);
  const auto& sizes = Words(header, "SIZE", fields.size(), name);
  const auto& types = Words(header, "TYPE", fields.size(), name);
  const bool counted = header.entries.contains("COUNT");
  Values values;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::size_t count = counted ? Count(header, "COUNT", Words(header, "COUNT", fields.size(), name)[i]) : 1;
    if (count == 0 || count > most || values.types.size() + count > most)
      throw InputError(header.where.at("COUNT"), "so many values of a point are not in the file", "",
                       std::to_string(count));
    values.names.resize(values.names.size() + count);
    values.names[values.types.size()] = fields[i];
    values.types.resize(values.names.size(), TypeOf(header.where.at("TYPE"), types[i], sizes[i]));
  }
  return values;
}

std::size_t Points(const Header& header, const std::string& name) {
  const std::size_t width = Count(header, "WIDTH", Words(header, "WIDTH", 1, name)[0]);
  const std::size_t height = Count(header, "HEIGHT", Words(header, "HEIGHT", 1, name)[0]);
  if (height != 0 && width > kMost / height)
    throw InputError(header.where.at("WIDTH"), "more points than can be counted");
  if (!header.entries.contains("POINTS")) return width * height;
  const std::size_t points = Count(header, "POINTS", Words(header, "POINTS", 1, name)[0]);
  if (points != width * height)
    throw InputError(header.where.at("POINTS"), "POINTS is not WIDTH times HEIGHT", std::to_string(width * height),
                     std::to_string(points));
  return points;
}

void ReadAscii(std::string_view data, const Header& header, const std::string& name, std::size_t points,
               const Columns& columns, std::vector<double>& row, CloudFile& file) {
  Lines lines(data);
  std::vector<std::string_view> words;
  std::size_t count = 0;
  while (const auto line = lines.Next()) {
    SplitWords(*line, words);
    if (words.empty()) continue;
    const std::string where = name + ":" + std::to_string(header.lines + lines.number());
    if (++count > points) throw InputError(where, "more points than the header says", std::to_string(points));
    if (words.size() != row.size())
      throw InputError(where, "another number of values than fields", std::to_string(row.size()),
                       std::to_string(words.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto number = ToNumber<double>(words[i]);
      if (!number) throw InputError(where, "no number", "", Quoted(words[i]));
      row[i] = *number;
    }
    columns.Add(row, file);
  }
  if (count < points)
    throw InputError(name + ":" + std::to_string(header.lines + lines.number()), "the file ends early",
                     std::to_string(points) + " points", std::to_string(count));
}

void ReadBinary(BinaryReader reader, const std::vector<Scalar>& types, std::size_t points, const Columns& columns,
                std::vector<double>& row, CloudFile& file) {
  std::size_t size = 0;
  for (const Scalar type : types) size += SizeOf(type);
  if (points > reader.left() / size || reader.left() != points * size)
    throw InputError(reader.Where(), "not as many bytes as the header says",
                     std::to_string(points) + " points of " + std::to_string(size),
                     std::to_string(reader.left()) + " bytes");
  file.cloud.positions.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t j = 0; j < types.size(); ++j) row[j] = reader.Read(types[j]);
    columns.Add(row, file);
  }
}

}  // namespace

CloudFile ParsePcd(std::string_view bytes, const std::string& name) {
  const Header header = ReadHeader(bytes, name);
  const Values values = ReadValues(header, bytes.size(), name);
  const std::size_t points = Points(header, name);
  const Columns columns(values.names, header.where.at("FIELDS"));
  std::vector<double> row(values.types.size());
  CloudFile file;
  const std::string& data = Words(header, "DATA", 1, name)[0];
  const std::string_view rest = bytes.substr(header.data_at);
  if (data == "ascii")
    ReadAscii(rest, header, name, points, columns, row, file);
  else if (data == "binary")
    ReadBinary({rest, std::endian::little, header.data_at, name}, values.types, points, columns, row, file);
  else
    throw InputError(header.where.at("DATA"), "these data are not read", "ascii or binary", Quoted(data));
  return file;
}

}  // namespace merlin
