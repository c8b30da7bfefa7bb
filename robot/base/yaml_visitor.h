// Configs from YAML and back: visitors over each config's Visit function (see robot/base/config.h).
#pragma once

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "robot/base/config.h"
#include "robot/base/error.h"
#include "robot/base/nearest_name.h"

namespace merlin {

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

// Fills a config from a map node; collects every fault instead of stopping at the first.
class YamlReader {
 public:
  // sets: the dotted paths that --set has written over; faults there are its, not the file's.
  YamlReader(const YAML::Node& node, std::string file, std::string path, const std::set<std::string>& sets,
             std::vector<std::string>& faults)
      : node_(node), file_(std::move(file)), path_(std::move(path)), sets_(sets), faults_(faults) {}

  template <class T>
  void operator()(const char* key, T& value, Range range = {}) {
    known_.insert(key);
    const YAML::Node child = node_[key];
    if (!child.IsDefined()) return;
    Read(child, path_ + key, value, range);
  }

  // Reads the whole config, unknown keys included.
  template <class Config>
  void ReadInto(Config& config) {
    if (!node_.IsMap())
      return Fault(node_, path_.empty() ? "the file" : path_.substr(0, path_.size() - 1), "expected a map of keys");
    Visit(*this, config);
    std::set<std::string> seen;
    for (const auto& entry : node_) {
      const std::string key = entry.first.Scalar();
      if (!seen.insert(key).second) Fault(entry.first, path_ + key, "given twice");
      if (!known_.contains(key))
        Fault(entry.first, path_ + key, "unknown key; did you mean '" + NearestName(key, known_) + "'?");
    }
  }

  // For types that are read in their own way: a function ReadYaml(YamlReader&, node, field, value&) beside the type, and
  // WriteYaml(YAML::Emitter&, value&).
  std::string Where(const YAML::Node& node, const std::string& field) const {
    for (const std::string& set : sets_)
      if (field == set || field.starts_with(set + ".") || field.starts_with(set + "[")) return "--set";
    const YAML::Mark mark = node.Mark();
    return file_ + (mark.is_null() ? "" : ":" + std::to_string(mark.line + 1));
  }
  void Add(const InputError& fault) { faults_.push_back(fault.what()); }
  void Fault(const YAML::Node& node, const std::string& field, const std::string& what) {
    faults_.push_back(Where(node, field) + ": " + field + ": " + what);
  }

  template <class T>
  void ReadScalar(const YAML::Node& node, const std::string& field, T& value, Range range) {
    const char* kind = std::is_same_v<T, std::string> ? "a text"
                       : std::is_same_v<T, bool>      ? "true or false"
                       : std::is_integral_v<T>        ? "a whole number"
                                                      : "a number";
    const std::string got = node.IsScalar() ? "got '" + node.Scalar() + "'" : "got no single value";
    if (!Convert(node, value)) return Fault(node, field, "expected " + std::string(kind) + ", " + got);
    if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      const double number = static_cast<double>(value);
      if (!std::isfinite(number) || !(number >= range.min && number <= range.max))
        Fault(node, field,
              "expected a number in [" + detail::Text(range.min) + ", " + detail::Text(range.max) + "], " + got);
    }
  }

 private:
  template <class T>
  void Read(const YAML::Node& node, const std::string& field, T& value, Range range) {
    if constexpr (IsOptional<T>::value) {
      if (node.IsNull()) return value.reset();
      Read(node, field, value.emplace(), range);
    } else if constexpr (requires { ReadYaml(*this, node, field, value); }) {
      ReadYaml(*this, node, field, value);
    } else if constexpr (IsVector<T>::value) {
      if (!node.IsSequence()) return Fault(node, field, "expected a list");
      value.clear();
      for (std::size_t i = 0; i < node.size(); ++i)
        Read(node[i], field + "[" + std::to_string(i) + "]", value.emplace_back(), range);
    } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>) {
      YamlReader(node, file_, field + ".", sets_, faults_).ReadInto(value);
    } else {
      ReadScalar(node, field, value, range);
    }
  }

  // As typed: yaml-cpp takes 010 for eight.
  template <class T>
  static bool Convert(const YAML::Node& node, T& value) {
    if (!node.IsScalar()) return false;
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
      const std::string& text = node.Scalar();
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      return error == std::errc() && end == text.data() + text.size();
    } else {
      return YAML::convert<T>::decode(node, value);
    }
  }

  YAML::Node node_;
  std::string file_, path_;
  const std::set<std::string>& sets_;
  std::vector<std::string>& faults_;
  std::set<std::string> known_;
};

// Writes a config with every default.
class YamlWriter {
 public:
  explicit YamlWriter(YAML::Emitter& out) : out_(out) {}

  template <class T>
  void operator()(const char* key, T& value, Range = {}) {
    if constexpr (IsOptional<T>::value) {
      if (value) (*this)(key, *value);
    } else {
      out_ << YAML::Key << key << YAML::Value;
      Write(value);
    }
  }
  template <class T>
  void Write(T& value) {
    if constexpr (requires { WriteYaml(out_, value); }) {
      WriteYaml(out_, value);
    } else if constexpr (IsVector<T>::value) {
      out_ << YAML::BeginSeq;
      for (auto& item : value) Write(item);
      out_ << YAML::EndSeq;
    } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>) {
      out_ << YAML::BeginMap;
      Visit(*this, value);
      out_ << YAML::EndMap;
    } else {
      out_ << value;
    }
  }

 private:
  YAML::Emitter& out_;
};

}  // namespace merlin
