// Writes a config (robot/base/config.h) as YAML, every default included: reading it back gives the same config. A type
// with a format of its own defines WriteYaml(YAML::Emitter&, T&) beside it.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <type_traits>

#include "robot/base/config.h"
#include "robot/base/yaml_reader.h"

namespace merlin {

class YamlWriter {
 public:
  explicit YamlWriter(YAML::Emitter& out) : out_(out) {}

  template <class T>
  void operator()(const char* key, T& value, Range = {}) {
    if constexpr (detail::IsOptional<T>::value) {
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
    } else if constexpr (detail::IsVector<T>::value) {
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

// digits: significant digits of every number; 17 keep all bits.
template <class Config>
std::string ToYamlText(Config config, int digits) {
  YAML::Emitter out;
  out.SetDoublePrecision(static_cast<std::size_t>(digits));
  YamlWriter(out).Write(config);
  return std::string(out.c_str()) + "\n";
}

}  // namespace merlin
