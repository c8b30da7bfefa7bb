#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "tools/cloud/cloud_file.h"
#include "tools/cloud/columns.h"
#include "tools/cloud/lzf.h"
#include "tools/cloud/scalar.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

using namespace cloud_text;

constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();

// PCL's packed colour: in a field rgb or rgba a 4-byte number, whose bytes from the highest are 0 (or alpha), red,
// green, blue.
struct PackedColour {
  std::size_t column = 0;
  bool as_float = false;  // the row holds a float with these bits instead of the number

  // Unpacks it into the last three values of the row.
  void Unpack(std::vector<double>& row) const {
    const double value = row[column], most = as_float ? std::numeric_limits<float>::max() : 4294967295.0;
    std::uint32_t bits = 0;
    if (std::abs(value) <= most)
      bits = as_float ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                      : static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
    for (std::size_t i = 0; i < 3; ++i) row[row.size() - 1 - i] = bits >> 8 * i & 255;
  }
};

// The values of a point. A field with COUNT n has n values, of which only the first has a name.
struct Values {
  std::vector<std::string_view> names;  // refer to the words of the header
  std::vector<Scalar> types;
  std::vector<std::size_t> field_bytes;  // of all values of each field together
  std::optional<PackedColour> colour{};  // adds three names, of the colours
};

struct PcdHeader {
  std::map<std::string, std::vector<std::string>> entries;  // keyword to its words
  std::map<std::string, std::string> where;
  std::size_t lines = 0, data_at = 0;
};

PcdHeader ReadPcdHeader(std::string_view bytes, const std::string& name) {
  PcdHeader header;
  Lines lines = Lines::OfFile(bytes);
  FaultList faults(name);
  std::vector<std::string_view> words;
  while (const auto line = lines.Next()) {
    SplitWords(*line, words);
    if (words.empty() || words.front().starts_with('#')) continue;
    const std::string where = name + ":" + std::to_string(lines.number());
    const std::string key(words.front() == "COLUMNS" ? "FIELDS" : words.front());  // up to version 0.6
    static const std::vector<std::string> kKeys{"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                                "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    faults.Try([&] {
      if (std::ranges::find(kKeys, key) == kKeys.end())
        throw InputError(where, "not a line of a PCD header", "VERSION, FIELDS, SIZE, TYPE, ... DATA", Quoted(key));
      if (!header.entries.try_emplace(key, words.begin() + 1, words.end()).second)
        throw InputError(where, key + " is there twice");
    });
    header.where[key] = where;
    if (key != "DATA") continue;
    faults.ThrowIfAny();
    header.lines = lines.number();
    header.data_at = lines.at();
    return header;
  }
  faults.ThrowIfAny();
  throw InputError(name, "the header does not end", "a line DATA");
}

// The words of an entry, which must be `count` of them (0: any number but none).
const std::vector<std::string>& Words(const PcdHeader& header, const char* key, std::size_t count,
                                      const std::string& name) {
  const auto entry = header.entries.find(key);
  if (entry == header.entries.end()) throw InputError(name, std::string("the header has no line ") + key);
  if (count == 0 ? entry->second.empty() : entry->second.size() != count)
    throw InputError(header.where.at(key), std::string(key) + " has another number of words",
                     count == 0 ? "some" : std::to_string(count), std::to_string(entry->second.size()));
  return entry->second;
}

std::size_t Count(const PcdHeader& header, const std::string& key, const std::string& word) {
  const auto number = ToNumber<std::size_t>(word);
  if (!number) throw InputError(header.where.at(key), key + " is no count", "a whole number", Quoted(word));
  return *number;
}

Scalar PcdTypeOf(const std::string& where, const std::string& type, const std::string& size) {
  static const std::map<std::string, Scalar> kTypes{
      {"I1", Scalar::kInt8},  {"U1", Scalar::kUint8},  {"I2", Scalar::kInt16}, {"U2", Scalar::kUint16},
      {"I4", Scalar::kInt32}, {"U4", Scalar::kUint32}, {"I8", Scalar::kInt64}, {"U8", Scalar::kUint64},
      {"F4", Scalar::kFloat}, {"F8", Scalar::kDouble}};
  const auto found = kTypes.find(type + size);
  if (found == kTypes.end())
    throw InputError(where, "no such type", "I or U of 1, 2, 4, 8 bytes, F of 4 or 8", Quoted(type + " of " + size));
  return found->second;
}

Values ReadValues(const PcdHeader& header, std::size_t most, const std::string& name) {
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
    const Scalar type = PcdTypeOf(header.where.at("TYPE"), types[i], sizes[i]);
    values.types.resize(values.names.size(), type);
    values.field_bytes.push_back(count * SizeOf(type));
  }
  for (std::size_t i = 0; i < values.types.size() && !values.colour; ++i)
    if ((values.names[i] == "rgb" || values.names[i] == "rgba") && SizeOf(values.types[i]) == 4)
      values.colour = PackedColour{.column = i, .as_float = !IsWhole(values.types[i])};
  if (std::ranges::find(values.names, "red") != values.names.end()) values.colour.reset();
  if (values.colour) values.names.insert(values.names.end(), {"red", "green", "blue"});
  return values;
}

std::size_t Points(const PcdHeader& header, const std::string& name) {
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

void ReadAscii(std::string_view data, const PcdHeader& header, const Values& values, const std::string& name,
               std::size_t points, Columns& columns, CloudFile& file) {
  std::vector<double> row(values.names.size());
  Lines lines(data);
  FaultList faults(name);
  std::vector<std::string_view> words;
  std::size_t count = 0;
  while (const auto line = lines.Next()) {
    SplitWords(*line, words);
    if (words.empty()) continue;
    const std::string where = name + ":" + std::to_string(header.lines + lines.number());
    faults.Try([&] {
      if (++count > points) throw InputError(where, "more points than the header says", std::to_string(points));
      if (words.size() != values.types.size())
        throw InputError(where, "another number of values than fields", std::to_string(values.types.size()),
                         std::to_string(words.size()));
      for (std::size_t i = 0; i < words.size(); ++i) {
        const auto number = ToNumber<double>(words[i]);
        if (!number) throw InputError(where, "no number", "", Quoted(words[i]));
        row[i] = *number;
      }
      if (values.colour) values.colour->Unpack(row);
      columns.Add(row, file);
    });
  }
  faults.Try([&] {
    if (count < points)
      throw InputError(name + ":" + std::to_string(header.lines + lines.number()), "the file ends early",
                       std::to_string(points) + " points", std::to_string(count));
  });
  faults.ThrowIfAny();
}

std::size_t Size(const Values& values) {
  std::size_t size = 0;
  for (const std::size_t bytes : values.field_bytes) size += bytes;
  return size;
}

void ReadBinary(BinaryReader reader, Values values, std::size_t points, const std::string& name, Columns& columns,
                CloudFile& file) {
  std::vector<double> row(values.names.size());
  if (values.colour) {
    values.types[values.colour->column] = Scalar::kUint32;
    values.colour->as_float = false;
  }
  const std::size_t size = Size(values);
  if (points > reader.left() / size)
    throw InputError(reader.Where(), "not as many bytes as the header says",
                     std::to_string(points) + " points of " + std::to_string(size),
                     std::to_string(reader.left()) + " bytes");
  // PCL up to 1.8 writes zeros there.
  if (reader.left() > points * size) file.warnings.push_back(BytesBehind(name, reader.left() - points * size));
  file.cloud.positions.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t j = 0; j < values.types.size(); ++j) row[j] = reader.Read(values.types[j]);
    if (values.colour) values.colour->Unpack(row);
    columns.Add(row, file);
  }
}

// DATA binary_compressed: the compressed and the original size, then the fields in LZF: the first field of all points,
// the second of all points, and so on. Returns the bytes in the order of DATA binary, point by point.
std::string Decompressed(BinaryReader reader, std::string_view rest, const PcdHeader& header, const Values& values,
                         std::size_t points, const std::string& name, CloudFile& file) {
  constexpr std::size_t kHead_bytes = 8;
  const auto compressed = static_cast<std::size_t>(reader.Read(Scalar::kUint32));
  const std::string where = reader.Where();
  const auto whole = static_cast<std::size_t>(reader.Read(Scalar::kUint32));
  if (compressed > reader.left())
    throw InputError(reader.Where(), "the file ends within the compressed data", std::to_string(compressed) + " bytes",
                     std::to_string(reader.left()));
  const std::size_t size = Size(values);
  if (points != whole / size || whole % size != 0)
    throw InputError(where, "not as many bytes as the header says",
                     std::to_string(points) + " points of " + std::to_string(size), std::to_string(whole) + " bytes");
  if (reader.left() > compressed) file.warnings.push_back(BytesBehind(name, reader.left() - compressed));
  const std::string by_field =
      DecompressLzf(rest.substr(kHead_bytes, compressed), whole, header.data_at + kHead_bytes, name);
  std::string by_point(by_field.size(), '\0');
  std::size_t from = 0, place = 0;
  for (const std::size_t bytes : values.field_bytes) {
    for (std::size_t i = 0; i < points; ++i, from += bytes)
      std::copy_n(by_field.begin() + static_cast<std::ptrdiff_t>(from), bytes,
                  by_point.begin() + static_cast<std::ptrdiff_t>(i * size + place));
    place += bytes;
  }
  return by_point;
}

}  // namespace

CloudFile ParsePcd(std::string_view bytes, const std::string& name) {
  const PcdHeader header = ReadPcdHeader(bytes, name);
  const Values values = ReadValues(header, bytes.size(), name);
  const std::size_t points = Points(header, name);
  Columns columns(values.names, header.where.at("FIELDS"));
  CloudFile file;
  const std::string& data = Words(header, "DATA", 1, name)[0];
  const std::string_view rest = bytes.substr(header.data_at);
  const auto reader = [&](std::string_view part) {
    return BinaryReader(part, std::endian::little, header.data_at, name);
  };
  if (data == "ascii") {
    ReadAscii(rest, header, values, name, points, columns, file);
  } else if (data == "binary") {
    ReadBinary(reader(rest), values, points, name, columns, file);
  } else if (data == "binary_compressed") {
    const std::string by_point = Decompressed(reader(rest), rest, header, values, points, name, file);
    ReadBinary(reader(by_point), values, points, name, columns, file);
  } else {
    throw InputError(header.where.at("DATA"), "these data are not read", "ascii, binary or binary_compressed",
                     Quoted(data));
  }
  const std::optional<std::size_t> colour = columns.colour();
  columns.GiveColours(file, colour && (*colour >= values.types.size() || IsWhole(values.types[*colour])));
  return file;
}

}  // namespace merlin
