// What surfaces are, by material name (models/materials.yaml): optical properties, all in the near infrared (870 nm),
// measured or listed per material and never derived from a visible colour, how they hold a tyre, and whether they stop
// a car.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace merlin::sim {

struct Material {
  double nir_albedo = 0.5;          // diffuse reflectance, [0, 1]
  double mirror = 0.0;              // specular reflectance, [0, 1]: mirrors, polished metal; nir_albedo + mirror <= 1
  double glass_transmission = 0.0;  // of a pane at normal incidence, absorption only, without the Fresnel losses at its
                                    // faces, [0, 1]; 0: no glass
  double retro_gain = 1.0;          // times a Lambertian surface's brightness, seen from the lamp, [1, 10000]:
                                    // retro-reflectors 100-1000
  double grip = 1.0;                // of a tyre on it: its friction there over the car's tyre_friction, [0.01, 2]
  bool passable = false;            // what is made of it needs no contact: the car drives through curtains and leaves
};

struct Materials {
  Material fallback;  // the stated default: what an unnamed or unlisted material is
  std::map<std::string, Material> by_name;

  const Material& Find(const std::string& name) const {
    const auto it = by_name.find(name);
    return it == by_name.end() ? fallback : it->second;
  }
};

// File: `default: {nir_albedo: 0.5}` (may be absent) and `materials: {white_wall: {nir_albedo: 0.8}, ...}`; the keys of
// a material are the fields above, all but nir_albedo may be absent. Throws InputError for what it cannot read, an
// unknown key (names the nearest), a name listed twice, an albedo that is missing, or a number outside its range: all
// faults at once, a line each, with file and line.
Materials ReadMaterials(const std::filesystem::path& file);

// What every geom of the model is made of, by its material's name; index: geom id.
std::vector<Material> GeomMaterials(const mjModel* model, const Materials& materials);

}  // namespace merlin::sim
