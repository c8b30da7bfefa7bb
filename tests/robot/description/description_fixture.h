// A folder for changed copies of the shipped URDF and data sheets, and what the InputErrors of their readers say.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "tests/robot/description/car_text.h"

namespace merlin {

namespace fs = std::filesystem;

class Description : public testing::Test {
 protected:
  static fs::path Model(const std::string& name) { return fs::path(MERLIN_SOURCE_DIR) / "models" / name; }
  static std::string Text(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // The message of the InputError that a call throws; empty if there is none.
  template <class Call>
  static std::string ErrorOf(Call call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  static const CarLink& Link(const CarDescription& car, const char* name) {
    return *std::find_if(car.links.begin(), car.links.end(), [&](const CarLink& link) { return link.name == name; });
  }

  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "merlin_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    fs::create_directory_symlink(Model("merlin/meshes"), folder_ / "meshes");
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path File(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string CarError(const std::string& urdf) const {
    return ErrorOf([&] { ReadCar(File("car.urdf", urdf)); });
  }
  std::string DepthError(const std::string& yaml) const {
    return ErrorOf([&] { ReadDepthCameraSheet(File("camera.yaml", yaml)); });
  }
  // The sheet of the PMD 3k-S with these lines as its errors.
  std::string WithErrors(const std::string& lines) const {
    return pmd_.substr(0, pmd_.find("errors:")) + "errors:\n" + lines;
  }
  std::string ColorError(const std::string& yaml) const {
    return ErrorOf([&] { ReadColorCameraSheet(File("camera.yaml", yaml)); });
  }

  fs::path folder_;
  std::string merlin_ = Text(Model("merlin/merlin.urdf"));
  std::string pmd_ = Text(Model("cameras/pmd_3k_s.yaml"));
  std::string ccd_ = Text(Model("cameras/ccd.yaml"));
};

}  // namespace merlin
