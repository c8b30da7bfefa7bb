#include "sim/world/materials.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "robot/base/error.h"

namespace merlin::sim {
namespace {

// A file that is removed at the end of the test.
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

TEST(ReadMaterials, IgnoresAByteOrderMark) {
  const TemporaryFile file("\xEF\xBB\xBFmaterials:\n  white_wall: {nir_albedo: 0.8}\n");
  EXPECT_DOUBLE_EQ(ReadMaterials(file.path()).Find("white_wall").nir_albedo, 0.8);
}

TEST(ReadMaterials, KnowsWhatIsPassable) {
  const TemporaryFile file(
      "materials:\n"
      "  cloth: {nir_albedo: 0.8, passable: true}\n"
      "  board: {nir_albedo: 0.8, passable: false}\n"
      "  wall: {nir_albedo: 0.8}\n");
  const Materials materials = ReadMaterials(file.path());
  EXPECT_TRUE(materials.Find("cloth").passable);
  EXPECT_FALSE(materials.Find("board").passable);
  EXPECT_FALSE(materials.Find("wall").passable);
  EXPECT_FALSE(materials.Find("never heard of").passable);
  ExpectContains(ErrorOf("materials:\n  cloth: {nir_albedo: 0.8, passable: 7}\n"),
                 ":2: materials.cloth.passable: expected true or false, got '7'");
  ExpectContains(ErrorOf("materials:\n  cloth: {nir_albedo: 0.8, passable: [true]}\n"),
                 "materials.cloth.passable: expected true or false");
}

TEST(ReadMaterials, HasHalfAsDefaultWhenTheFileGivesNone) {
  const TemporaryFile file("materials: {}\n");
  EXPECT_DOUBLE_EQ(ReadMaterials(file.path()).Find("wall").nir_albedo, 0.5);
}

TEST(ReadMaterials, NamesTheNearestKeyAndTheLine) {
  ExpectContains(ErrorOf("materials:\n  wall:\n    nir_albedo: 0.5\n    nir_albdo: 0.8\n"),
                 ".yaml:4: materials.wall.nir_albdo: unknown key; did you mean 'nir_albedo'?");
  ExpectContains(ErrorOf("materials: {}\n\nmaterial: {}\n"),
                 ".yaml:3: material: unknown key; did you mean 'materials'?");
  ExpectContains(ErrorOf("defalt: {nir_albedo: 0.5}\nmaterials: {}\n"),
                 ".yaml:1: defalt: unknown key; did you mean 'default'?");
}

TEST(ReadMaterials, RejectsABadAlbedo) {
  for (const char* albedo : {"1.01", "-0.1", ".nan", ".inf", "bright", "", "[0.5]", "0.5 m"}) {
    const std::string error = ErrorOf(std::string("materials:\n  wall: {nir_albedo: ") + albedo + "}\n");
    ExpectContains(error, ".yaml:2: materials.wall.nir_albedo: expected a number in [0, 1], got");
  }
  ExpectContains(ErrorOf("materials:\n  wall: {}\n"), ".yaml:2: materials.wall: missing key 'nir_albedo'");
  ExpectContains(ErrorOf("default: {nir_albedo: 2}\nmaterials: {}\n"),
                 ".yaml:1: default.nir_albedo: expected a number in [0, 1], got '2'");
}

TEST(ReadMaterials, TakesMirrorsGlassAndRetroReflectors) {
  const TemporaryFile file(
      "materials:\n"
      "  plain: {nir_albedo: 0.8}\n"
      "  mirror: {nir_albedo: 0.1, mirror: 0.9}\n"
      "  pane: {nir_albedo: 0.02, glass_transmission: 1}\n"
      "  sheet: {nir_albedo: 0.3, retro_gain: 1000}\n");
  const Materials materials = ReadMaterials(file.path());
  const Material plain = materials.Find("plain");
  EXPECT_EQ(plain.mirror, 0.0);
  EXPECT_EQ(plain.glass_transmission, 0.0);
  EXPECT_EQ(plain.retro_gain, 1.0);
  EXPECT_DOUBLE_EQ(materials.Find("mirror").mirror, 0.9);
  EXPECT_DOUBLE_EQ(materials.Find("pane").glass_transmission, 1.0);
  EXPECT_DOUBLE_EQ(materials.Find("sheet").retro_gain, 1000.0);
}

TEST(ReadMaterials, RefusesNumbersOutOfRange) {
  const auto refuse = [](const std::string& entry, const std::string& what) {
    ExpectContains(ErrorOf("materials:\n  a: {nir_albedo: 0.5, " + entry + "}\n"), ".yaml:2: materials.a." + what);
  };
  for (const char* value : {"-0.01", "1.01", ".nan", "bright", "[1]"}) {
    refuse(std::string("mirror: ") + value, "mirror: expected a number in [0, 1], got");
    refuse(std::string("glass_transmission: ") + value, "glass_transmission: expected a number in [0, 1], got");
  }
  for (const char* value : {"0.99", "0", "-2", "10001", ".inf", ".nan"}) {
    refuse(std::string("retro_gain: ") + value, "retro_gain: expected a number in [1, 10000], got");
  }
  refuse("miror: 0.1", "miror: unknown key; did you mean 'mirror'?");
}

TEST(ReadMaterials, RefusesToReflectMoreThanComesIn) {
  ExpectContains(ErrorOf("materials:\n  a: {nir_albedo: 0.5, mirror: 0.51}\n"),
                 ".yaml:2: materials.a.nir_albedo: nir_albedo + mirror: expected at most 1, got 1.01");
  for (const char* all :
       {"{nir_albedo: 0.7, mirror: 0.3}", "{nir_albedo: 0, mirror: 1}", "{nir_albedo: 0.9, mirror: 0.1}"}) {
    EXPECT_EQ(ErrorOf(std::string("materials:\n  a: ") + all + "\n"), "no error") << all;
  }
}

TEST(ReadMaterials, RefusesAnotherShape) {
  ExpectContains(ErrorOf(""), "holds no map of keys; expected a file of materials");
  ExpectContains(ErrorOf("- wall\n"), "holds no map of keys; expected a file of materials");
  ExpectContains(ErrorOf("default: {nir_albedo: 0.5}\n"), "missing key 'materials'");
  ExpectContains(ErrorOf("materials: 0.5\n"), ".yaml:1: materials: expected a map of keys, got '0.5'");
  ExpectContains(ErrorOf("materials:\n  wall: 0.5\n"), ".yaml:2: materials.wall: expected a map of keys, got '0.5'");
  ExpectContains(ErrorOf("materials:\n  a: {nir_albedo: 0.5}\n  a: {nir_albedo: 0.6}\n"),
                 ".yaml:3: materials.a: given twice");
}

TEST(ReadMaterials, ReportsAllFaultsAtOnce) {
  const std::string error = ErrorOf("materials:\n  a: {nir_albedo: 7}\n  b: {albedo: 1}\n");
  ExpectContains(error, ".yaml:2: materials.a.nir_albedo: expected");
  ExpectContains(error, ".yaml:3: materials.b.albedo: unknown key");
  ExpectContains(error, ".yaml:3: materials.b: missing key 'nir_albedo'");
  EXPECT_EQ(ErrorOf("materials:\n  a: {mirror: 0.8}\n").find("nir_albedo + mirror"), std::string::npos);
  const std::string one = ErrorOf("materials:\n  a: {mirror: 2, glass_transmission: 2, retro_gain: 0}\n");
  ExpectContains(one, ".yaml:2: materials.a: missing key 'nir_albedo'");
  for (const char* field : {"mirror", "glass_transmission", "retro_gain"})
    ExpectContains(one, std::string(".yaml:2: materials.a.") + field + ": expected a number in");
}

TEST(ReadMaterials, KnowsEveryMaterialOfTheRooms) {
  const std::filesystem::path models = MERLIN_SOURCE_DIR "/models";
  const Materials materials = ReadMaterials(models / "materials.yaml");
  EXPECT_GT(materials.Find("window_glass").glass_transmission, 0.5);
  EXPECT_GT(materials.Find("mirror").mirror, 0.5);
  EXPECT_GE(materials.Find("retro_sheet").retro_gain, 100.0);
  for (const auto& entry : std::filesystem::directory_iterator(models / "rooms")) {
    char error[1000] = "";
    mjModel* model = mj_loadXML(entry.path().c_str(), nullptr, error, sizeof error);
    ASSERT_NE(model, nullptr) << error;
    for (int i = 0; i < model->nmat; ++i) {
      const char* name = mj_id2name(model, mjOBJ_MATERIAL, i);
      EXPECT_TRUE(materials.by_name.contains(name)) << entry.path() << ": " << name;
    }
    mj_deleteModel(model);
  }
}

TEST(GeomMaterials, GoByTheMaterialsName) {
  char error[1000] = "";
  mjSpec* spec =
      mj_parseXMLString(R"(<mujoco><asset><material name="pane"/><material name="unlisted"/></asset><worldbody>
    <geom size="1"/><geom size="1" material="pane" rgba="0 0 0 1"/><geom size="1" material="unlisted"/>
    </worldbody></mujoco>)",
                        nullptr, error, sizeof error);
  ASSERT_NE(spec, nullptr) << error;
  mjModel* model = mj_compile(spec, nullptr);
  mj_deleteSpec(spec);
  ASSERT_NE(model, nullptr);
  Materials materials;
  materials.fallback.nir_albedo = 0.25;
  materials.by_name["pane"] = {.nir_albedo = 0.02, .glass_transmission = 0.9};
  const std::vector<Material> by_geom = GeomMaterials(model, materials);
  mj_deleteModel(model);
  ASSERT_EQ(by_geom.size(), 3u);
  EXPECT_EQ(by_geom[0].nir_albedo, 0.25);
  EXPECT_EQ(by_geom[1].nir_albedo, 0.02);
  EXPECT_EQ(by_geom[1].glass_transmission, 0.9);
  EXPECT_EQ(by_geom[2].nir_albedo, 0.25);
  EXPECT_EQ(by_geom[2].glass_transmission, 0.0);
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
