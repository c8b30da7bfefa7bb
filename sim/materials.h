// Optical properties by material name (models/materials.yaml). The near-infrared albedo is measured or listed per
// material, never derived from a visible colour.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace merlin::sim {

struct Material {
  double nir_albedo = 0.5;  // diffuse, at 870 nm, in [0, 1]
};

struct Materials {
  Material fallback;  // the stated default: what an unnamed or unlisted material is
  std::map<std::string, Material> by_name;

  const Material& Find(const std::string& name) const {
    const auto it = by_name.find(name);
    return it == by_name.end() ? fallback : it->second;
  }
};

// File: `default: {nir_albedo: 0.5}` (may be absent) and `materials: {white_wall: {nir_albedo: 0.8}, ...}`.
// Throws InputError for what it cannot read, an unknown key (names the nearest), a name listed twice, or an albedo that
// is missing or outside [0, 1]: all faults at once, a line each, with file and line.
Materials ReadMaterials(const std::filesystem::path& file);

// Near-infrared albedo of every geom of the model, by its material's name.
std::vector<double> GeomAlbedos(const mjModel* model, const Materials& materials);

}  // namespace merlin::sim
