#include "sim/tof/surroundings.h"

#include <cmath>
#include <string>

#include "robot/base/error.h"
#include "sim/rays/ray_group.h"

namespace merlin::sim {
namespace {

std::optional<double> Numeric(const mjModel* model, const char* name, double min) {
  const int id = mj_name2id(model, mjOBJ_NUMERIC, name);
  if (id < 0) return std::nullopt;
  const double value = model->numeric_data[model->numeric_adr[id]];
  if (!std::isfinite(value) || value < min)
    throw InputError("the room", std::string("the numeric '") + name + "' is out of range",
                     "a number from " + std::to_string(min) + " on", std::to_string(value));
  return value;
}

std::optional<Sun> SunOf(const mjModel* model) {
  const int light = mj_name2id(model, mjOBJ_LIGHT, "sun");
  if (light < 0) return std::nullopt;
  Sun sun;
  const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 1>> direction(model->light_dir + 3 * light);
  sun.to_sun = -direction.normalized();
  sun.irradiance_w_m2_nm = Numeric(model, "sun_w_m2_nm", 0.0).value_or(sun.irradiance_w_m2_nm);
  return sun;
}

// A box: its two larger edges span the pane.
Window WindowOf(const mjModel* model, int geom, const Pose& T_world_body) {
  const Pose T_world_geom = T_world_body * ToPose(model->geom_pos + 3 * geom, model->geom_quat + 4 * geom);
  const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 1>> half(model->geom_size + 3 * geom);
  Eigen::Index thin = 0;
  half.minCoeff(&thin);
  return {T_world_geom.translation(), T_world_geom.linear().col(thin), 4.0 * half.prod() / half[thin]};
}

}  // namespace

Surroundings SurroundingsOf(const mjModel* model, const Materials& materials) {
  Surroundings around;
  around.material = GeomMaterials(model, materials);
  around.material_id.assign(model->geom_matid, model->geom_matid + model->ngeom);
  around.sun = SunOf(model);
  around.ambient_w_m2_nm = Numeric(model, "ambient_w_m2_nm", 0.0).value_or(around.ambient_w_m2_nm);
  around.temperature_c = Numeric(model, "temperature_c", -273.15).value_or(around.temperature_c);
  const std::vector<Pose> T_world_body = ReferencePoses(model);
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const char* name = mj_id2name(model, mjOBJ_GEOM, geom);
    const bool pane = around.material[static_cast<std::size_t>(geom)].glass_transmission > 0.0;
    if (name != nullptr && std::string_view(name).starts_with("window") && pane && model->geom_type[geom] == mjGEOM_BOX)
      around.windows.push_back(WindowOf(model, geom, T_world_body[static_cast<std::size_t>(model->geom_bodyid[geom])]));
  }
  return around;
}

std::vector<bool> PanesOf(const Surroundings& around) {
  std::vector<bool> panes;
  for (const Material& material : around.material) panes.push_back(material.glass_transmission > 0.0);
  return panes;
}

}  // namespace merlin::sim
