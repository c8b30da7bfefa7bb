#include "sim/materials.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "robot/types/error.h"

namespace merlin::sim {
namespace {

// A file that is gone when the test is over.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("merlin_materials_" + std::to_string(getpid()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string ErrorOf(const std::string& text) {
  const TemporaryFile file(text);
  try {
    ReadMaterials(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void ExpectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

TEST(ReadMaterials, TakesAlbedosAndDefault) {
  const TemporaryFile file(
      "default: {nir_albedo: 0.4}\n"
      "materials:\n"
      "  white_wall: {nir_albedo: 0.8}\n"
      "  black: {nir_albedo: 0}\n"
      "  mirror: {nir_albedo: 1}\n");
  const Materials materials = ReadMaterials(file.path());
  EXPECT_DOUBLE_EQ(materials.Find("white_wall").nir_albedo, 0.8);
  EXPECT_DOUBLE_EQ(materials.Find("black").nir_albedo, 0.0);
  EXPECT_DOUBLE_EQ(materials.Find("mirror").nir_albedo, 1.0);
  EXPECT_DOUBLE_EQ(materials.Find("never heard of").nir_albedo, 0.4);
  EXPECT_DOUBLE_EQ(materials.Find("").nir_albedo, 0.4);
  EXPECT_EQ(materials.by_name.size(), 3u);
}

TEST(ReadMaterials, HasHalfAsDefaultWhenTheFileGivesNone) {
  const TemporaryFile file("materials: {}\n");
  EXPECT_DOUBLE_EQ(ReadMaterials(file.path()).Find("wall").nir_albedo, 0.5);
}

TEST(ReadMaterials, NamesTheNearestKeyAndTheLine) {
  ExpectContains(ErrorOf("materials:\n  wall:\n    nir_albedo: 0.5\n    nir_albdo: 0.8\n"),
                 ".yaml:4: unknown key 'nir_albdo'; expected 'nir_albedo'");
  ExpectContains(ErrorOf("materials: {}\n\nmaterial: {}\n"), ".yaml:3: unknown key 'material'; expected 'materials'");
  ExpectContains(ErrorOf("defalt: {nir_albedo: 0.5}\nmaterials: {}\n"),
                 ".yaml:1: unknown key 'defalt'; expected 'default'");
}

TEST(ReadMaterials, RefusesAnAlbedoThatIsNone) {
  for (const char* albedo : {"1.01", "-0.1", ".nan", ".inf", "bright", "", "[0.5]", "0.5 m"}) {
    const std::string error = ErrorOf(std::string("materials:\n  wall: {nir_albedo: ") + albedo + "}\n");
    ExpectContains(error, ".yaml:2: nir_albedo of material 'wall'; expected a number in [0, 1], got");
  }
  ExpectContains(ErrorOf("materials:\n  wall: {}\n"), ".yaml:2: nir_albedo of material 'wall' is missing");
  ExpectContains(ErrorOf("default: {nir_albedo: 2}\nmaterials: {}\n"), ".yaml:1: nir_albedo of material 'default'");
}

TEST(ReadMaterials, RefusesAnotherShape) {
  ExpectContains(ErrorOf(""), "no materials in the file");
  ExpectContains(ErrorOf("- wall\n"), "no materials in the file");
  ExpectContains(ErrorOf("default: {nir_albedo: 0.5}\n"), "no materials in the file");
  ExpectContains(ErrorOf("materials: 0.5\n"), ".yaml:1: 'materials' is not a map");
  ExpectContains(ErrorOf("materials:\n  wall: 0.5\n"), ".yaml:2: material 'wall' is not a map");
  ExpectContains(ErrorOf("materials:\n  a: {nir_albedo: 0.5}\n  a: {nir_albedo: 0.6}\n"),
                 ".yaml:3: material 'a' is listed twice");
}

TEST(ReadMaterials, ReportsAllFaultsAtOnce) {
  const std::string error = ErrorOf("materials:\n  a: {nir_albedo: 7}\n  b: {albedo: 1}\n");
  ExpectContains(error, ".yaml:2: nir_albedo of material 'a'");
  ExpectContains(error, ".yaml:3: unknown key 'albedo'");
  ExpectContains(error, ".yaml:3: nir_albedo of material 'b' is missing");
}

TEST(ReadMaterials, NamesTheLineOfBrokenYaml) {
  ExpectContains(ErrorOf("materials:\n  a: {nir_albedo: 0.5}\n  b: {nir_albedo: 0.5\n  c: ]\n"),
                 ".yaml:4: broken YAML");
}

TEST(ReadMaterials, NamesAFileThatIsNotThere) {
  for (const char* path : {"/no/such/materials.yaml", "/tmp"}) {
    try {
      ReadMaterials(path);
      FAIL() << path;
    } catch (const InputError& error) {
      ExpectContains(error.what(), std::string(path) + ": cannot be read");
    }
  }
}

}  // namespace
}  // namespace merlin::sim
