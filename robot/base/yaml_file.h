// A YAML file that holds one config, read whole or not at all.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/yaml_visitor.h"

namespace merlin {

class YamlFile {
 public:
  // Throws InputError for a file that cannot be read, is no YAML or holds no map; what: "a calibration file".
  YamlFile(const std::filesystem::path& file, const std::string& what) : file_(file.string()) {
    try {
      root_ = YAML::LoadFile(file_);
    } catch (const YAML::BadFile&) {
      throw InputError(file_, "cannot be read", what);
    } catch (const YAML::Exception& error) {
      throw InputError(file_ + ":" + std::to_string(error.mark.line + 1), "broken YAML: " + error.msg);
    }
    if (!root_.IsMap()) throw InputError(file_, "no map of keys", what);
  }

  // Keys without which the file means nothing.
  void Require(std::initializer_list<const char*> keys) {
    for (const char* key : keys)
      if (!root_[key].IsDefined()) faults_.push_back(file_ + ": missing key '" + key + "'");
  }

  // Throws InputError with every fault, a line each.
  template <class Config>
  void ReadInto(Config& config) {
    YamlReader(root_, file_, "", {}, faults_).ReadInto(config);
    if (faults_.empty()) return;
    std::string all = faults_.front();
    for (std::size_t i = 1; i < faults_.size(); ++i) all += "\n" + faults_[i];
    throw InputError(all);
  }

 private:
  std::string file_;
  YAML::Node root_;
  std::vector<std::string> faults_;
};

}  // namespace merlin
