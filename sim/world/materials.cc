#include "sim/world/materials.h"

#include <fmt/format.h>

#include "robot/base/yaml_reader.h"

namespace merlin::sim {
namespace {

constexpr double kRetroGainMax = 1e4;  // a larger value is taken for a typing error
constexpr double kRounding = 1e-12;    // rounding error of a sum of two decimal numbers

}  // namespace

void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field, Material& material) {
  YamlReader map(reader.file(), node, field);
  map.Need("nir_albedo", material.nir_albedo, {0.0, 1.0});
  map("mirror", material.mirror, {0.0, 1.0});
  map("glass_transmission", material.glass_transmission, {0.0, 1.0});
  map("retro_gain", material.retro_gain, {1.0, kRetroGainMax});
  map("grip", material.grip, {0.01, 2.0});
  map("passable", material.passable);
  const double sum = material.nir_albedo + material.mirror;
  map.Rule(sum <= 1.0 + kRounding, {"nir_albedo", "mirror"},
           fmt::format("nir_albedo + mirror: expected at most 1, got {:g}", sum));
  map.RefuseUnknown();
}

Materials ReadMaterials(const std::filesystem::path& file) {
  YamlFile yaml(file, "a file of materials");
  YamlReader map(yaml, yaml.root(), "");
  Materials materials;
  map("default", materials.fallback);
  map.Need("materials", materials.by_name);
  map.RefuseUnknown();
  yaml.ThrowFaults();
  return materials;
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
