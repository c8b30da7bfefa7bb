#include "tools/camera/stage.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "robot/base/error.h"
#include "sim/actors/actors.h"
#include "sim/world/room.h"
#include "tools/camera/inside.h"

namespace merlin {
namespace {

constexpr double kFarthestWall_m = 1000.0;
constexpr double kWallHalf_m = 50.0, kWallThickness_m = 0.2;
constexpr double kTiltMax_deg = 89.0;

void FinishStage(Stage& stage) {
  const mjModel* model = stage.model.get();
  const std::vector<bool> none(static_cast<std::size_t>(model->nbody), false);
  stage.bodies = sim::AtRest(model);
  stage.scene = std::make_unique<sim::RayScene>(model, none, sim::PanesOf(stage.surroundings));
}

void Require(bool holds, const char* option, const std::string& what, const std::string& expected, double got) {
  if (!holds) throw InputError(option, what, expected, fmt::format("{:g}", got));
}

void RefuseStrangeGeoms(const std::string& room, const mjModel* model, const mjData* data) {
  for (int geom = 0; geom < model->ngeom; ++geom)
    if (!Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * geom).allFinite())
      throw InputError(room, "geom '" + sim::GeomName(model, geom) + "' stands nowhere", "a finite position");
}

}  // namespace

Pose BodyOptical() {
  Pose T_body_optical = Pose::Identity();
  T_body_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_body_optical;
}

Stage BuildStage(const std::string& geoms, const std::vector<sim::Material>& material) {
  sim::SilenceMujoco();
  char error[1024] = "";
  const std::string mjcf = "<mujoco><compiler angle='radian'/><worldbody>" + geoms + "</worldbody></mujoco>";
  const sim::SpecPtr spec(mj_parseXMLString(mjcf.c_str(), nullptr, error, sizeof error), mj_deleteSpec);
  if (!spec) throw std::logic_error(std::string("a stage of ours is no MJCF: ") + error);
  Stage stage;
  stage.model.reset(mj_compile(spec.get(), nullptr));
  if (!stage.model)
    throw std::logic_error(std::string("a stage of ours does not compile: ") + mjs_getError(spec.get()));
  if (std::ssize(material) != stage.model->ngeom) throw std::logic_error("a stage needs one material a geom");
  stage.surroundings.material = material;
  stage.surroundings.material_id.assign(material.size(), -1);
  FinishStage(stage);
  return stage;
}

Stage WallStage(const Wall& wall) {
  const double tilt_deg = wall.tilt_rad * 180.0 / std::numbers::pi;
  Require(wall.distance_m > 0.0 && wall.distance_m <= kFarthestWall_m, "--wall", "no distance",
          fmt::format("metres above 0, up to {:g}", kFarthestWall_m), wall.distance_m);
  Require(wall.albedo >= 0.0 && wall.albedo <= 1.0, "--albedo", "no albedo", "a number in [0, 1]", wall.albedo);
  Require(std::abs(tilt_deg) <= kTiltMax_deg + 1e-9, "--tilt-deg", "too steep", "-89 to 89 degrees", tilt_deg);
  Require(wall.ambient_w_m2_nm >= 0.0 && std::isfinite(wall.ambient_w_m2_nm), "--sun", "no irradiance",
          "W/m2/nm, from 0 on", wall.ambient_w_m2_nm);
  // The surface's middle is on the axis, the box behind it.
  const double half_m = 0.5 * kWallThickness_m;
  Stage stage =
      BuildStage(fmt::format("<geom name='wall' type='box' size='{} {} {}' pos='{} {} 0' euler='0 0 {}'/>", half_m,
                             kWallHalf_m, kWallHalf_m, wall.distance_m + half_m * std::cos(wall.tilt_rad),
                             half_m * std::sin(wall.tilt_rad), wall.tilt_rad),
                 {{.nir_albedo = wall.albedo}});
  stage.surroundings.ambient_w_m2_nm = wall.ambient_w_m2_nm;
  return stage;
}

Stage RoomStage(const RoomView& view) {
  const std::string room = view.room.string();
  const sim::SpecPtr spec = sim::ReadRoom(view.room, view.curtain_closed);
  spec->compiler.discardvisual = 0;
  sim::Actors::AddTo(spec.get(), view.actors, {});
  Stage stage;
  stage.model.reset(mj_compile(spec.get(), nullptr));
  const mjModel* model = stage.model.get();
  if (model == nullptr) throw sim::RoomError(view.room, "the room does not compile", mjs_getError(spec.get()));
  if (!HasVisibleGeom(model)) throw InputError(room, "an empty room", "at least one visible geom");
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model), mj_deleteData);
  if (!data) throw std::runtime_error("MuJoCo cannot make its data: out of memory");
  mj_kinematics(model, data.get());
  RefuseStrangeGeoms(room, model, data.get());
  if (const auto geom = GeomAround(model, data.get(), view.T_world_body.translation()))
    throw InputError("--pose", "the camera cannot be inside matter", "a free place",
                     "one inside '" + *geom + "' of " + room);
  stage.surroundings = sim::SurroundingsOf(model, sim::ReadMaterials(view.materials));
  if (view.sun_w_m2_nm) {
    Require(*view.sun_w_m2_nm >= 0.0 && std::isfinite(*view.sun_w_m2_nm), "--sun", "no irradiance",
            "W/m2/nm, from 0 on", *view.sun_w_m2_nm);
    if (!stage.surroundings.sun)
      throw InputError("--sun", room + " has no sun", "a room with a directional light named 'sun'");
    stage.surroundings.sun->irradiance_w_m2_nm = *view.sun_w_m2_nm;
  }
  FinishStage(stage);
  stage.T_world_optical = view.T_world_body * BodyOptical();
  return stage;
}

}  // namespace merlin
