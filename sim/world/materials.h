// Properties of surfaces by material name (models/materials.yaml): optical properties in the near infrared (870 nm),
// the grip of a tyre, and whether a car can drive through. The optical values are measured or listed for each material;
// they are never derived from a visible colour.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace merlin::sim {

struct Material {
  double nir_albedo = 0.5;  // diffuse reflectance, [0, 1]
  double mirror = 0.0;      // specular reflectance, [0, 1]: mirrors, polished metal; nir_albedo + mirror <= 1
  double glass_transmission =
      0.0;                  // of a pane at normal incidence, [0, 1]: absorption only, without the Fresnel losses
                            // at its faces; 0: not glass
  double retro_gain = 1.0;  // brightness seen from the lamp over that of a Lambertian surface, [1, 10000];
                            // retro-reflectors have 100-1000
  double grip = 1.0;        // friction of a tyre on it over the car's tyre_friction, [0.01, 2]
  bool passable = false;    // the car can drive through it: curtains, leaves
};

struct Materials {
  Material fallback;  // for materials without a name and names that are not listed
  std::map<std::string, Material> by_name;

  const Material& Find(const std::string& name) const {
    const auto it = by_name.find(name);
    return it == by_name.end() ? fallback : it->second;
  }
};

// The file has `default: {nir_albedo: 0.5}` (optional) and `materials: {white_wall: {nir_albedo: 0.8}, ...}`. The keys
// of a material are the fields above; only nir_albedo is required. Throws InputError for a file that cannot be read, an
// unknown key (and suggests the nearest), a name listed twice, a missing albedo, or a number outside its range. It
// lists all faults at once, one per line, each with its file and line.
Materials ReadMaterials(const std::filesystem::path& file);

// The material of every geom of the model, found by name; indexed by geom id.
std::vector<Material> GeomMaterials(const mjModel* model, const Materials& materials);

}  // namespace merlin::sim
