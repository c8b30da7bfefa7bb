#include "sim/world/materials.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string_view>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"

namespace merlin::sim {
namespace {

constexpr double kRetroGainMax = 1e4;  // brighter ones are typing errors
constexpr double kRounding = 1e-12;    // of a sum of two decimal numbers
constexpr std::array<std::string_view, 2> kFileKeys{"default", "materials"};
constexpr std::array<std::string_view, 6> kMaterialKeys{"nir_albedo", "mirror", "glass_transmission",
                                                        "retro_gain", "grip",   "passable"};

// Collects every fault of one file, so that a person mends them in one go.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file.string()) {}

  Materials Read(const YAML::Node& root) {
    Materials materials;
    if (!root.IsMap() || !root["materials"]) {
      Fault(root, "no materials in the file", "a map with the key 'materials'");
    }
    if (root.IsMap()) {
      CheckKeys(root, kFileKeys);
      if (root["default"]) materials.fallback = ReadMaterial("default", root["default"]);
      if (root["materials"]) materials.by_name = ReadByName(root["materials"]);
    }
    if (!faults_.empty()) throw InputError(faults_);
    return materials;
  }

 private:
  void Fault(const YAML::Node& node, const std::string& what, const std::string& expected,
             const std::string& got = "") {
    const auto where = node.Mark().is_null() ? file_ : fmt::format("{}:{}", file_, node.Mark().line + 1);
    if (!faults_.empty()) faults_ += "\n";
    faults_ += InputError(where, what, expected, got).what();
  }

  void CheckKeys(const YAML::Node& map, std::span<const std::string_view> known) {
    for (const auto& entry : map) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (std::ranges::find(known, key) == known.end()) {
        Fault(entry.first, fmt::format("unknown key '{}'", key), fmt::format("'{}'", NearestName(key, known)));
      }
    }
  }

  std::map<std::string, Material> ReadByName(const YAML::Node& map) {
    std::map<std::string, Material> by_name;
    if (!map.IsMap()) {
      Fault(map, "'materials' is not a map", "name: {nir_albedo: number}");
      return by_name;
    }
    for (const auto& entry : map) {
      const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (!by_name.emplace(name, ReadMaterial(name, entry.second)).second) {
        Fault(entry.first, fmt::format("material '{}' is listed twice", name), "each name once");
      }
    }
    return by_name;
  }

  Material ReadMaterial(const std::string& name, const YAML::Node& node) {
    Material material;
    if (!node.IsMap()) {
      Fault(node, fmt::format("material '{}' is not a map", name), "{nir_albedo: number}");
      return material;
    }
    CheckKeys(node, kMaterialKeys);
    const bool has_albedo = static_cast<bool>(node["nir_albedo"]);
    if (!has_albedo) Fault(node, fmt::format("nir_albedo of material '{}' is missing", name), "a number in [0, 1]");
    const bool albedo_read = has_albedo && ReadNumber(name, node, "nir_albedo", material.nir_albedo, 0.0, 1.0);
    const bool mirror_read = ReadNumber(name, node, "mirror", material.mirror, 0.0, 1.0);
    ReadNumber(name, node, "glass_transmission", material.glass_transmission, 0.0, 1.0);
    ReadNumber(name, node, "retro_gain", material.retro_gain, 1.0, kRetroGainMax);
    ReadNumber(name, node, "grip", material.grip, 0.01, 2.0);
    if (const YAML::Node passable = node["passable"])
      if (!passable.IsScalar() || !YAML::convert<bool>::decode(passable, material.passable))
        Fault(passable, fmt::format("passable of material '{}'", name), "true or false",
              passable.IsScalar() ? passable.Scalar() : "no truth value");
    const double sum = material.nir_albedo + material.mirror;
    if (albedo_read && mirror_read && sum > 1.0 + kRounding) {
      Fault(node, fmt::format("nir_albedo + mirror of material '{}'", name), "at most 1", fmt::format("{:g}", sum));
    }
    return material;
  }

  // False if the key's number is none or outside its range; an absent key leaves the value.
  bool ReadNumber(const std::string& name, const YAML::Node& material, const char* key, double& value, double min,
                  double max) {
    const YAML::Node node = material[key];
    if (!node || (node.IsScalar() && YAML::convert<double>::decode(node, value) && value >= min && value <= max)) {
      return true;
    }
    Fault(node, fmt::format("{} of material '{}'", key, name), fmt::format("a number in [{:g}, {:g}]", min, max),
          node.IsScalar() ? node.Scalar() : "no number");
    return false;
  }

  std::string file_;
  std::string faults_;
};

}  // namespace

Materials ReadMaterials(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!std::filesystem::is_regular_file(file) || !stream) {
    throw InputError(file.string(), "cannot be read", "a readable file of materials");
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  try {
    return Reader(file).Read(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}", file.string(), error.mark.line + 1), "broken YAML: " + error.msg);
  }
}

std::vector<Material> GeomMaterials(const mjModel* model, const Materials& materials) {
  std::vector<Material> by_geom;
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const int material = model->geom_matid[geom];
    const char* name = material < 0 ? "" : mj_id2name(model, mjOBJ_MATERIAL, material);
    by_geom.push_back(materials.Find(name == nullptr ? "" : name));
  }
  return by_geom;
}

}  // namespace merlin::sim
