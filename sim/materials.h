// Optical properties by material name (models/materials.yaml). The near-infrared albedo is measured or listed per
// material, never derived from a visible colour.
#pragma once

#include <filesystem>
#include <map>
#include <string>

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

// Throws InputError (file, line, what) for what it cannot read, an unknown key, or an albedo outside [0, 1].
Materials ReadMaterials(const std::filesystem::path& file);

}  // namespace merlin::sim
