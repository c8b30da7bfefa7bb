#include "sim/world/surface.h"

#include <algorithm>
#include <ranges>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"

namespace merlin::sim {
namespace {

// Of two geoms in contact the one of higher priority sets friction and stiffness; at equal priority the larger friction
// would count. So the floor gets a higher priority than the tyres, and the tyre's values except for the friction.
void HoldTyres(mjModel* model, int floor, int tyre, double grip) {
  model->geom_priority[floor] = model->geom_priority[tyre] + 1;
  model->geom_condim[floor] = model->geom_condim[tyre];
  std::copy_n(model->geom_friction + 3 * tyre, 3, model->geom_friction + 3 * floor);
  std::copy_n(model->geom_solref + mjNREF * tyre, mjNREF, model->geom_solref + mjNREF * floor);
  std::copy_n(model->geom_solimp + mjNIMP * tyre, mjNIMP, model->geom_solimp + mjNIMP * floor);
  model->geom_friction[3 * floor] *= grip;
}

}  // namespace

void SetGrip(mjModel* model, const std::vector<bool>& is_floor, int tyre, const Materials& materials,
             const std::string& surface) {
  if (!surface.empty() && !materials.by_name.contains(surface))
    throw InputError("drivetrain.surface", "unknown material '" + surface + "'",
                     "'" + NearestName(surface, std::views::keys(materials.by_name)) + "'");
  const std::vector<Material> own = GeomMaterials(model, materials);
  for (int geom = 0; geom < model->ngeom; ++geom) {
    if (!is_floor[static_cast<std::size_t>(geom)]) continue;
    const double grip = surface.empty() ? own[static_cast<std::size_t>(geom)].grip : materials.Find(surface).grip;
    if (grip != 1.0) HoldTyres(model, geom, tyre, grip);  // at 1 the tyre's own friction is right already
  }
}

}  // namespace merlin::sim
