// The one reader of our YAML files: scenarios, camera data sheets, materials, mappings of cars, hardware files and
// calibrations.
//
//   YamlFile file(path, "a file of materials");  // unreadable or broken: throws at once
//   file.ReadInto(config);                        // every other fault is noted ...
//   file.ThrowFaults();                           // ... and thrown here, a line each
//
// A config says what its keys are with its Visit function (robot/base/config.h). A fault reads
//   FILE:LINE: field: expected a number in [0, 1], got 'bright'
// where field is the dotted path (materials.wall.nir_albedo, obstacles[2].height_m). Unknown keys name the nearest
// known one, and a key given twice is a fault. Byte-order marks are ignored.
#pragma once

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "robot/base/config.h"
#include "robot/base/fault_list.h"

namespace merlin {

// Every finite number above 0.
inline constexpr Range kPositive{std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};

struct YamlEntry {
  std::string key;
  YAML::Node key_node, value;
};

// A file as a tree of nodes, and the faults found in it so far.
class YamlFile {
 public:
  // what: "a scenario file". Throws InputError for a file that cannot be read, that is broken YAML (with the line) or
  // that holds no map of keys.
  YamlFile(const std::filesystem::path& file, const std::string& what);

  // Applies "a.b=c" to the tree. c is YAML, so numbers, texts and lists work alike. Throws InputError for a text that
  // is not an assignment. Faults in a value that was set here name --set instead of the file.
  void Set(const std::string& assignment);
  bool IsSet(const std::string& field) const { return sets_.contains(field); }

  template <class Config>
  void ReadInto(Config& config);

  // For rules that only one kind of file has.
  void Require(const std::string& map_field, std::initializer_list<const char*> keys);
  void Fault(const std::string& field, const std::string& what);
  void Fault(const YAML::Node& node, const std::string& field, const std::string& what);
  void Add(const InputError& fault) { faults_.Add(fault); }
  std::size_t fault_count() const { return faults_.count(); }
  // Throws one InputError with every fault, if there is any.
  void ThrowFaults() const { faults_.ThrowIfAny(); }

  const YAML::Node& root() const { return root_; }
  // "FILE:LINE", or "--set".
  std::string Where(const YAML::Node& node, const std::string& field) const;
  // The entries of a map, each key once. Notes a fault for a node that is not a map, a key that is not a name, and a
  // key given twice. A node without a value (`errors:`) is an empty map.
  std::vector<YamlEntry> Entries(const YAML::Node& node, const std::string& field);

 private:
  struct Place {
    YAML::Node node;
    YAML::Mark mark;    // of its key; in a list, of the node itself
    bool found = true;  // false: there is no such field; this is the nearest around it
  };
  Place Find(const std::string& field) const;
  static void Descend(Place& place, const std::string& part, bool is_index);

  std::string file_;
  YAML::Node root_;
  std::set<std::string> sets_;
  FaultList faults_;
};

// One map of the file, and the visitor that fills a config from it. A value that is wrong leaves its variable as it
// was.
//
// A type with a format of its own defines, beside it,
//   void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field, T& value);
class YamlReader {
 public:
  // field: the map's dotted path; empty for the whole file.
  YamlReader(YamlFile& file, const YAML::Node& map, const std::string& field)
      : file_(file),
        map_(map),
        field_(field),
        is_map_(map.IsMap() || map.IsNull()),
        entries_(file.Entries(map, field)) {}

  // A key that may be left out.
  template <class T>
  void operator()(const char* key, T& value, Range range = {}) {
    known_.insert(key);
    const YamlEntry* entry = Find(key);
    if (entry == nullptr) return;
    const std::size_t before = file_.fault_count();
    Read(entry->value, Field(key), value, range);
    if (file_.fault_count() > before) wrong_.insert(key);
  }
  // A key that must be there.
  template <class T>
  void Need(const char* key, T& value, Range range = {}) {
    if (Find(key) == nullptr) Missing(key);
    (*this)(key, value, range);
  }
  double Number(const char* key, Range range) {
    double number = 1.0;  // not 0, so that what is computed from a missing number stays finite
    Need(key, number, range);
    return number;
  }
  // Null: the file does not give it.
  const YamlEntry* Find(const std::string& key) const;

  // A rule between the values of several keys. It is checked only if each value is valid by itself. The fault is
  // reported at the first key.
  void Rule(bool holds, std::initializer_list<const char*> keys, const std::string& what);
  // Call last: every key that was not read is a fault.
  void RefuseUnknown();

  template <class Config>
  void ReadInto(Config& config) {
    Visit(*this, config);
    RefuseUnknown();
  }

  template <class T>
  void Read(const YAML::Node& node, const std::string& field, T& value, Range range = {});
  template <class T>
  void ReadScalar(const YAML::Node& node, const std::string& field, T& value, Range range = {});

  YamlFile& file() { return file_; }
  std::string Where(const YAML::Node& node, const std::string& field) const { return file_.Where(node, field); }
  void Fault(const YAML::Node& node, const std::string& field, const std::string& what) {
    file_.Fault(node, field, what);
  }
  void Add(const InputError& fault) { file_.Add(fault); }

 private:
  std::string Field(const std::string& key) const { return field_.empty() ? key : field_ + "." + key; }
  void Missing(const char* key);
  void Expected(const YAML::Node& node, const std::string& field, const std::string& what);
  // Notes a fault and returns false for a number that is not finite or outside the range.
  bool IsIn(Range range, double number, const YAML::Node& node, const std::string& field);

  YamlFile& file_;
  YAML::Node map_;
  std::string field_;
  bool is_map_;
  std::vector<YamlEntry> entries_;
  std::set<std::string> known_;
  std::set<std::string> wrong_;  // keys that are missing, or whose value has a fault
};

namespace detail {

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsMap : std::false_type {};
template <class T>
struct IsMap<std::map<std::string, T>> : std::true_type {};

}  // namespace detail

template <class Config>
void YamlFile::ReadInto(Config& config) {
  YamlReader(*this, root_, "").ReadInto(config);
}

template <class T>
void YamlReader::Read(const YAML::Node& node, const std::string& field, T& value, Range range) {
  if constexpr (detail::IsOptional<T>::value) {
    if (node.IsNull()) return value.reset();
    Read(node, field, value.emplace(), range);
  } else if constexpr (requires { ReadYaml(*this, node, field, value); }) {
    ReadYaml(*this, node, field, value);
  } else if constexpr (detail::IsVector<T>::value) {
    if (!node.IsSequence()) return Expected(node, field, "a list");
    value.clear();
    for (std::size_t i = 0; i < node.size(); ++i)
      Read(node[i], field + "[" + std::to_string(i) + "]", value.emplace_back(), range);
  } else if constexpr (detail::IsMap<T>::value) {
    for (const YamlEntry& entry : file_.Entries(node, field))
      Read(entry.value, field + "." + entry.key, value[entry.key], range);
  } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>) {
    YamlReader(file_, node, field).ReadInto(value);
  } else {
    ReadScalar(node, field, value, range);
  }
}

template <class T>
void YamlReader::ReadScalar(const YAML::Node& node, const std::string& field, T& value, Range range) {
  T read{};
  if constexpr (std::is_same_v<T, std::string>) {
    if (!node.IsScalar()) return Expected(node, field, "a text");
    read = node.Scalar();
  } else if constexpr (std::is_same_v<T, bool>) {
    if (!node.IsScalar() || !YAML::convert<bool>::decode(node, read)) return Expected(node, field, "true or false");
  } else if constexpr (std::is_integral_v<T>) {
    // Decimal, as typed: yaml-cpp would read 010 as eight.
    const std::string text = node.IsScalar() ? node.Scalar() : "";
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
    if (error != std::errc() || end != text.data() + text.size() || text.empty())
      return Expected(node, field, std::is_unsigned_v<T> ? "a whole number, 0 or more" : "a whole number");
    if (!IsIn(range, static_cast<double>(read), node, field)) return;
  } else {
    double number = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, number)) number = std::nan("");
    if (!IsIn(range, number, node, field)) return;
    read = static_cast<T>(number);
  }
  value = std::move(read);
}

}  // namespace merlin
