#include "sim/actors/actor_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "robot/base/error.h"
#include "sim/rays/ray_group.h"
#include "sim/world/room.h"
#include "sim/world/shape.h"
#include "sim/world/solid.h"
#include "sim/world/spec.h"

namespace merlin::sim {
namespace {

struct ShapeKind {
  std::string name;
  mjtGeom type;
  std::size_t sizes;
};

const std::vector<ShapeKind>& ShapeKinds() {
  static const std::vector<ShapeKind> kinds{{"box", mjGEOM_BOX, 3},
                                            {"sphere", mjGEOM_SPHERE, 1},
                                            {"capsule", mjGEOM_CAPSULE, 2},
                                            {"cylinder", mjGEOM_CYLINDER, 2},
                                            {"ellipsoid", mjGEOM_ELLIPSOID, 3}};
  return kinds;
}

const ShapeKind& KindOf(const std::string& shape) { return *std::ranges::find(ShapeKinds(), shape, &ShapeKind::name); }

mjsBody* AddBody(mjSpec* spec, const std::string& name, const mjsDefault* plain) {
  mjsBody* body = mjs_addBody(mjs_findBody(spec, "world"), plain);
  SetName(body->element, name);
  body->mocap = 1;
  body->pos[2] = kAwayHeight_m;
  return body;
}

// Gives the geom a material by name. Returns the material if it had to be added to the spec, else null.
mjsMaterial* SetMaterial(mjSpec* spec, const std::string& name, const mjsDefault* plain, mjsGeom* geom) {
  if (name.empty()) return nullptr;
  mjs_setString(geom->material, name.c_str());
  if (mjs_findElement(spec, mjOBJ_MATERIAL, name.c_str()) != nullptr) return nullptr;
  mjsMaterial* material = mjs_addMaterial(spec, plain);
  SetName(material->element, name);
  return material;
}

// The shape stands on the ground, centred above the body's origin.
void AddShape(mjSpec* spec, mjsBody* body, const ShapeKind& kind, const std::vector<double>& size_m,
              const std::string& material, const std::string& name, const mjsDefault* plain) {
  mjsGeom* geom = mjs_addGeom(body, plain);
  SetName(geom->element, name);
  geom->type = kind.type;
  geom->contype |= kMeetsCar;
  for (std::size_t i = 0; i < size_m.size(); ++i) geom->size[i] = size_m[i] / 2.0;
  geom->pos[2] = size_m.back() / 2.0;
  if (kind.type == mjGEOM_CAPSULE) geom->size[1] -= geom->size[0];  // MuJoCo's half length excludes the caps
  SetMaterial(spec, material, plain, geom);
}

ModelPtr CompileModel(const ActorConfig& actor) {
  const std::filesystem::path file = actor.model;
  SilenceMujoco();
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(file, unreadable))
    throw InputError(file.string(), "no such actor", "an MJCF file");
  char error[1024] = "";
  const SpecPtr spec(mj_parseXML(file.c_str(), nullptr, error, sizeof error), mj_deleteSpec);
  if (!spec) throw RoomError(file, "not an actor (MJCF)", error);
  spec->compiler.fusestatic = spec->compiler.discardvisual = 0;
  ModelPtr model(mj_compile(spec.get(), nullptr), mj_deleteModel);
  if (!model) throw RoomError(file, "the actor does not compile", mjs_getError(spec.get()));
  if (model->njnt > 0)
    throw InputError(file.string(), "an actor must be rigid", "no joints", fmt::format("{}", model->njnt));
  if (model->ngeom == 0) throw InputError(file.string(), "the actor has no geoms", "one geom or more");
  for (int geom = 0; geom < model->ngeom; ++geom)
    if (const int type = model->geom_type[geom]; type == mjGEOM_PLANE || type == mjGEOM_HFIELD || type == mjGEOM_SDF)
      throw InputError(file.string(), "'" + GeomName(model.get(), geom) + "' cannot be part of an actor",
                       "box, sphere, capsule, cylinder, ellipsoid or mesh",
                       "a plane, height field or signed distance field");
  return model;
}

void SetMesh(mjSpec* spec, const mjModel* model, int geom, const std::string& name, const mjsDefault* plain,
             mjsGeom* to) {
  const TriangleMesh from = MeshOf(model, geom);
  std::vector<float> corners;
  std::vector<int> triangles;
  for (const Eigen::Vector3d& vertex : from.vertices)
    for (const double value : vertex) corners.push_back(static_cast<float>(value));
  for (const std::array<int, 3>& triangle : from.triangles)
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  mjsMesh* mesh = mjs_addMesh(spec, plain);
  SetName(mesh->element, name);
  mjs_setFloat(mesh->uservert, corners.data(), static_cast<int>(corners.size()));
  mjs_setInt(mesh->userface, triangles.data(), static_cast<int>(triangles.size()));
  mesh->inertia = mjMESH_INERTIA_SHELL;  // not used, but the other kinds reject open meshes
  mjs_setString(to->meshname, name.c_str());
}

// Copies one geom. Attaching the model's spec would be shorter, but it adds prefixes to material names, which must
// stay.
void AddModelGeom(mjSpec* spec, mjsBody* body, const mjModel* model, int from, const Pose& T_actor_geom,
                  const mjsDefault* plain) {
  const std::string name = fmt::format("{}_{}", mjs_getString(mjs_getName(body->element)), GeomName(model, from));
  mjsGeom* geom = mjs_addGeom(body, plain);
  SetName(geom->element, name);
  geom->type = static_cast<mjtGeom>(model->geom_type[from]);
  const Eigen::Quaterniond q(T_actor_geom.linear());
  Eigen::Vector3d::Map(geom->pos) = T_actor_geom.translation();
  Eigen::Vector4d::Map(geom->quat) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  std::copy_n(model->geom_size + 3 * from, 3, geom->size);
  std::copy_n(model->geom_rgba + 4 * from, 4, geom->rgba);
  geom->group = model->geom_group[from];
  geom->contype = model->geom_contype[from], geom->conaffinity = model->geom_conaffinity[from];
  if (geom->contype != 0 || geom->conaffinity != 0) geom->contype |= kMeetsCar;
  if (geom->type == mjGEOM_MESH) SetMesh(spec, model, from, name, plain, geom);
  const int material = model->geom_matid[from];
  const char* material_name = material < 0 ? nullptr : mj_id2name(model, mjOBJ_MATERIAL, material);
  if (material_name == nullptr) return;
  if (mjsMaterial* made = SetMaterial(spec, material_name, plain, geom))
    std::copy_n(model->mat_rgba + 4 * material, 4, made->rgba);
}

}  // namespace

const std::vector<std::string>& ActorShapes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> made;
    for (const ShapeKind& kind : ShapeKinds()) made.push_back(kind.name);
    return made;
  }();
  return names;
}

std::size_t SizesOf(const std::string& shape) { return KindOf(shape).sizes; }

std::string BodyName(const ActorConfig& actor) { return "actor_" + actor.name; }
std::string ObstacleBodyName(std::size_t number) { return fmt::format("obstacle_{}", number); }

void AddActorBody(mjSpec* spec, const ActorConfig& actor) {
  const BuiltinDefaults plain;
  const std::string name = BodyName(actor);
  if (actor.model.empty()) {
    mjsBody* body = AddBody(spec, name, plain.get());
    return AddShape(spec, body, KindOf(actor.shape), actor.size_m, actor.material, name, plain.get());
  }
  const ModelPtr model = CompileModel(actor);
  mjsBody* body = AddBody(spec, name, plain.get());
  const std::vector<Pose> T_actor_body = ReferencePoses(model.get());
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const Pose T_body_geom = ToPose(model->geom_pos + 3 * geom, model->geom_quat + 4 * geom);
    AddModelGeom(spec, body, model.get(), geom,
                 T_actor_body[static_cast<std::size_t>(model->geom_bodyid[geom])] * T_body_geom, plain.get());
  }
}

void AddObstacleBody(mjSpec* spec, const ObstacleConfig& obstacle, std::size_t number) {
  const BuiltinDefaults plain;
  const std::string name = ObstacleBodyName(number);
  AddShape(spec, AddBody(spec, name, plain.get()), KindOf("box"),
           {obstacle.length_m, obstacle.width_m, obstacle.height_m}, obstacle.material, name, plain.get());
}

}  // namespace merlin::sim
