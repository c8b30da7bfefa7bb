#include "robot/base/yaml_reader.h"

#include <algorithm>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "robot/base/nearest_name.h"
#include "robot/base/text_fields.h"

namespace merlin {
namespace {

constexpr std::size_t kShown = 100;  // more than any of our files has keys: a file with more faults is of another kind

std::string Line(const YAML::Mark& mark) { return mark.is_null() ? "" : ":" + std::to_string(mark.line + 1); }

// Parses the whole text. where: its source, for errors.
YAML::Node ParseYaml(const std::string& text, const std::string& where, const std::string& what) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) throw InputError(where, "holds more than one YAML document", what);
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const YAML::Exception& error) {
    throw InputError(where + Line(error.mark), "broken YAML: " + error.msg);
  }
}

std::string Got(const YAML::Node& node) {
  return node.IsScalar() ? "'" + node.Scalar() + "'" : node.IsNull() ? "nothing" : "no single value";
}

std::string Words(Range range) {
  if (range.min == kPositive.min && range.max == kPositive.max) return "a positive number";
  if (std::isinf(range.min) && std::isinf(range.max)) return "a finite number";
  return "a number in [" + NumberText(range.min) + ", " + NumberText(range.max) + "]";
}

}  // namespace

YamlFile::YamlFile(const std::filesystem::path& file, const std::string& what)
    : file_(file.string()), root_(ParseYaml(ReadFile(file_, what), file_, what)), faults_(file_, kShown) {
  if (!root_.IsMap()) throw InputError(file_, "holds no map of keys", what);
}

void YamlFile::Set(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set", "not an assignment", "key.key=value", "'" + assignment + "'");
  const YAML::Node value = ParseYaml(assignment.substr(equals + 1), "--set " + assignment, "one value");
  YAML::Node node = root_;
  std::string path = assignment.substr(0, equals);
  sets_.insert(path);
  for (std::size_t dot; (dot = path.find('.')) != std::string::npos; path = path.substr(dot + 1)) {
    const YAML::Node child = node[path.substr(0, dot)];
    if (child.IsDefined() && !child.IsNull() && !child.IsMap())
      throw InputError("--set " + assignment, "'" + path.substr(0, dot) + "' has no keys below it");
    node.reset(child);
  }
  node[path] = value;
}

std::string YamlFile::Where(const YAML::Node& node, const std::string& field) const {
  for (const std::string& set : sets_)
    if (field == set || field.starts_with(set + ".") || field.starts_with(set + "[")) return "--set";
  // An empty value is reported in the line of its key: the parser places it at the token that follows.
  return file_ + Line(node.IsNull() ? Find(field).mark : node.Mark());
}

void YamlFile::Fault(const YAML::Node& node, const std::string& field, const std::string& what) {
  faults_.Add(Where(node, field) + ": " + (field.empty() ? "" : field + ": ") + what);
}

void YamlFile::Fault(const std::string& field, const std::string& what) { Fault(Find(field).node, field, what); }

void YamlFile::Require(const std::string& map_field, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const Place place = Find(map_field.empty() ? key : map_field + "." + key);
    if (!place.found) Fault(place.node, map_field, "missing key '" + std::string(key) + "'");
  }
}

YamlFile::Place YamlFile::Find(const std::string& field) const {
  Place place{.node = root_, .mark = root_.Mark()};
  for (std::size_t at = 0; at < field.size() && place.found;) {
    const bool is_index = field[at] == '[';
    const std::size_t end = is_index ? field.find(']', at) : std::min(field.find_first_of(".[", at), field.size());
    Descend(place, field.substr(at + is_index, end - at - is_index), is_index);
    at = end + is_index;
    if (at < field.size() && field[at] == '.') ++at;
  }
  return place;
}

// reset, not =: yaml-cpp's assignment changes the tree.
void YamlFile::Descend(Place& place, const std::string& part, bool is_index) {
  place.found = false;
  if (is_index && place.node.IsSequence()) {
    const YAML::Node list = place.node, item = list[std::stoul(part)];
    if (!item.IsDefined()) return;
    place.found = true;
    place.mark = item.Mark();
    return place.node.reset(item);
  }
  if (is_index || !place.node.IsMap()) return;
  for (const auto& entry : place.node) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != part) continue;
    place.found = true;
    place.mark = entry.first.Mark();
    return place.node.reset(entry.second);
  }
}

std::vector<YamlEntry> YamlFile::Entries(const YAML::Node& node, const std::string& field) {
  std::vector<YamlEntry> entries;
  if (node.IsNull()) return entries;
  if (!node.IsMap()) {
    Fault(node, field.empty() ? "the file" : field, "expected a map of keys, got " + Got(node));
    return entries;
  }
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      Fault(entry.first, field, "a key that is no name");
      continue;
    }
    const std::string key = entry.first.Scalar();
    if (std::ranges::find(entries, key, &YamlEntry::key) == entries.end())
      entries.push_back({key, entry.first, entry.second});
    else
      Fault(entry.first, field.empty() ? key : field + "." + key, "given twice");
  }
  return entries;
}

const YamlEntry* YamlReader::Find(const std::string& key) const {
  const auto entry = std::ranges::find(entries_, key, &YamlEntry::key);
  return entry == entries_.end() ? nullptr : &*entry;
}

void YamlReader::Missing(const char* key) {
  wrong_.insert(key);
  if (is_map_) Fault(map_, field_, "missing key '" + std::string(key) + "'");
}

void YamlReader::Expected(const YAML::Node& node, const std::string& field, const std::string& what) {
  Fault(node, field, "expected " + what + ", got " + Got(node));
}

bool YamlReader::IsIn(Range range, double number, const YAML::Node& node, const std::string& field) {
  if (std::isfinite(number) && number >= range.min && number <= range.max) return true;
  Expected(node, field, Words(range));
  return false;
}

void YamlReader::Rule(bool holds, std::initializer_list<const char*> keys, const std::string& what) {
  const bool sound = std::ranges::none_of(keys, [this](const char* key) { return wrong_.contains(key); });
  if (holds || !sound || !is_map_) return;
  const char* first = *keys.begin();
  const YamlEntry* entry = Find(first);
  Fault(entry == nullptr ? map_ : entry->value, Field(first), what);
}

void YamlReader::RefuseUnknown() {
  for (const YamlEntry& entry : entries_)
    if (!known_.contains(entry.key))
      Fault(entry.key_node, Field(entry.key), "unknown key; did you mean '" + NearestName(entry.key, known_) + "'?");
}

}  // namespace merlin
