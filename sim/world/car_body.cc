#include "sim/world/car_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "sim/world/solid.h"
#include "sim/world/spec.h"

namespace merlin::sim::car_body {
namespace {

constexpr double kPanInertia_kg_m2 = 2e-3;  // of the pan servo at its output; a guess, as for the steering servo

void SetPose(const Pose& pose, double pos[3], double quat[4]) {
  const Eigen::Quaterniond q(pose.linear());
  Eigen::Vector3d::Map(pos) = pose.translation();
  quat[0] = q.w(), quat[1] = q.x(), quat[2] = q.y(), quat[3] = q.z();
}

void SetInertial(const CarLink& link, mjsBody* body) {
  // ipos is NaN until it is set. Without explicitinertial MuJoCo would compute the mass from the geoms.
  body->mass = link.mass_kg;
  Eigen::Vector3d::Map(body->ipos) = link.T_link_inertial.translation();
  const Eigen::Matrix3d rotation = link.T_link_inertial.linear();
  const Eigen::Matrix3d inertia = rotation * link.inertia_kg_m2 * rotation.transpose();
  const double full[6] = {inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2)};
  if (link.mass_kg > 0.0) std::copy(full, full + 6, body->fullinertia);
  body->explicitinertial = 1;
}

bool IsPan(const CarDescription& car, std::size_t index) { return car.pan && car.pan->moves && car.pan->link == index; }

// Joints of wheels, knuckles and the pan unit move; all others are fixed at 0. The knuckles' range is set by the
// steering linkage (sim/drive/drivetrain.h).
bool Moves(const CarDescription& car, std::size_t index) {
  return FindWheel(car, index) != nullptr || std::ranges::find(car.knuckles, index) != car.knuckles.end() ||
         IsPan(car, index);
}

void AddJoint(const CarDescription& car, std::size_t index, const mjsDefault* plain, mjsBody* body) {
  if (!Moves(car, index)) return;
  mjsJoint* joint = mjs_addJoint(body, plain);
  SetName(joint->element, car.links[index].joint_name);
  joint->type = mjJNT_HINGE;
  Eigen::Vector3d::Map(joint->axis) = car.links[index].axis;
  joint->limited = mjLIMITED_FALSE;
  // Each wheel carries a quarter of the rotor's inertia, because behind ideal differentials the motor turns at the mean
  // speed of the four wheels. It is set here because MuJoCo would use only the diagonal of an inertia set on the motor
  // or the tendon.
  if (FindWheel(car, index) != nullptr)
    joint->armature = car.drivetrain.rotor_inertia_kg_m2 * car.drivetrain.gear * car.drivetrain.gear / 4.0;
  if (IsPan(car, index)) joint->armature = kPanInertia_kg_m2;
}

void SetMaterial(mjSpec* spec, const CarShape& shape, const mjsDefault* plain, mjsGeom* geom) {
  std::copy(shape.rgba.begin(), shape.rgba.end(), geom->rgba);
  if (shape.material.empty()) return;
  if (mjs_findElement(spec, mjOBJ_MATERIAL, shape.material.c_str()) == nullptr) {
    mjsMaterial* material = mjs_addMaterial(spec, plain);
    SetName(material->element, shape.material);
    std::copy(shape.rgba.begin(), shape.rgba.end(), material->rgba);
  }
  mjs_setString(geom->material, shape.material.c_str());
}

void SetMesh(mjSpec* spec, const CarShape& shape, const std::string& name, const mjsDefault* plain, mjsGeom* geom) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float) && sizeof(Eigen::Vector3i) == 3 * sizeof(int));
  mjsMesh* mesh = mjs_addMesh(spec, plain);
  SetName(mesh->element, name);
  const std::vector<Eigen::Vector3f>& vertices = shape.mesh->vertices;
  const std::vector<Eigen::Vector3i>& triangles = shape.mesh->triangles;
  mjs_setFloat(mesh->uservert, vertices.data()->data(), static_cast<int>(3 * vertices.size()));
  mjs_setInt(mesh->userface, triangles.data()->data(), static_cast<int>(3 * triangles.size()));
  Eigen::Vector3d::Map(mesh->scale) = shape.size_m;
  mesh->inertia = mjMESH_INERTIA_SHELL;  // not used, but the other kinds reject open meshes
  geom->type = mjGEOM_MESH;
  mjs_setString(geom->meshname, name.c_str());
}

mjsGeom* AddShape(mjSpec* spec, const CarShape& shape, const std::string& name, const mjsDefault* plain,
                  mjsBody* body) {
  mjsGeom* geom = mjs_addGeom(body, plain);
  SetName(geom->element, name);
  SetPose(shape.T_link_shape, geom->pos, geom->quat);
  const Eigen::Vector3d& size = shape.size_m;
  switch (shape.kind) {
    case CarShape::Kind::kBox:
      geom->type = mjGEOM_BOX;
      Eigen::Vector3d::Map(geom->size) = size / 2.0;
      break;
    case CarShape::Kind::kCylinder:
      geom->type = mjGEOM_CYLINDER;
      geom->size[0] = size.x(), geom->size[1] = size.y() / 2.0;
      break;
    case CarShape::Kind::kSphere:
      geom->type = mjGEOM_SPHERE;
      geom->size[0] = size.x();
      break;
    case CarShape::Kind::kMesh:
      SetMesh(spec, shape, name, plain, geom);
      break;
  }
  return geom;
}

// Touches the solid parts of the room but never the car itself, because steered wheels may overlap the chassis. The
// priority makes the car's friction and stiffness count: otherwise MuJoCo would use the larger friction of the pair,
// and a floor's default is 1.
void SetCollides(mjsGeom* geom) {
  geom->group = kCollisionGroup;
  geom->contype = kCarItself, geom->conaffinity = kMeetsCar;
  geom->priority = kCarPriority;
}

// Contact values tuned so that the car drives circles within 0.1 % of Ackermann's radius and does not drift at rest.
void AddTyre(const CarDescription& car, const CarWheel& wheel, const mjsDefault* plain, mjsBody* body) {
  mjsGeom* geom = mjs_addGeom(body, plain);
  SetName(geom->element, car.links[wheel.link].name + "_collision_0");
  SetPose(wheel.T_link_tyre, geom->pos, geom->quat);
  geom->type = mjGEOM_ELLIPSOID;
  geom->size[0] = geom->size[1] = car.wheel_radius_m, geom->size[2] = wheel.width_m / 2.0;
  geom->condim = 3;  // no torsional friction: a tyre steered on the spot would fight it
  geom->friction[0] = car.drivetrain.tyre_friction;
  geom->solref[0] = 0.01, geom->solref[1] = 1.0;
  geom->solimp[0] = 0.95, geom->solimp[1] = 0.99, geom->solimp[2] = 0.001;
  SetCollides(geom);
}

void AddVisual(mjSpec* spec, const CarLink& link, const mjsDefault* plain, mjsBody* body) {
  for (std::size_t i = 0; i < link.visual.size(); ++i) {
    mjsGeom* geom = AddShape(spec, link.visual[i], fmt::format("{}_visual_{}", link.name, i), plain, body);
    geom->group = kVisualGroup;
    geom->contype = geom->conaffinity = 0;
    SetMaterial(spec, link.visual[i], plain, geom);
  }
}

// The body that gets a link's collision shapes: the link's own if it moves relative to its parent, else the body that
// it is fixed to. Collision detection then tests six bodies instead of a dozen, which makes physics alone a quarter
// faster.
struct Carrier {
  mjsBody* body;
  Pose T_carrier_link;
};

void AddCollision(mjSpec* spec, const CarLink& link, const mjsDefault* plain, const Carrier& carrier) {
  for (std::size_t i = 0; i < link.collision.size(); ++i) {
    CarShape shape = link.collision[i];
    shape.T_link_shape = carrier.T_carrier_link * shape.T_link_shape;
    SetCollides(AddShape(spec, shape, fmt::format("{}_collision_{}", link.name, i), plain, carrier.body));
  }
}

}  // namespace

const CarWheel* FindWheel(const CarDescription& car, std::size_t link) {
  const auto wheel = std::ranges::find(car.wheels, link, &CarWheel::link);
  return wheel == car.wheels.end() ? nullptr : &*wheel;
}

void AddTo(mjSpec* spec, const CarDescription& car, const Pose& T_world_base) {
  const BuiltinDefaults plain;
  std::map<std::string, Carrier> carriers;
  for (std::size_t i = 0; i < car.links.size(); ++i) {
    const CarLink& link = car.links[i];
    mjsBody* body = mjs_addBody(mjs_findBody(spec, link.parent.empty() ? "world" : link.parent.c_str()), plain.get());
    SetName(body->element, link.name);
    if (link.parent.empty()) {
      SetPose(T_world_base, body->pos, body->quat);
      mjsJoint* joint = mjs_addFreeJoint(body);
      joint->align = mjALIGNFREE_FALSE;  // qpos is the base's pose, not that of the centre of mass
      SetName(joint->element, "car");
    } else {
      SetPose(link.T_parent_link, body->pos, body->quat);
      AddJoint(car, i, plain.get(), body);
    }
    Carrier carrier{body, Pose::Identity()};
    if (!Moves(car, i) && !link.parent.empty()) {
      carrier = carriers.at(link.parent);
      carrier.T_carrier_link = carrier.T_carrier_link * link.T_parent_link;
    }
    carriers.emplace(link.name, carrier);
    SetInertial(link, body);
    AddVisual(spec, link, plain.get(), body);
    if (const CarWheel* wheel = FindWheel(car, i))
      AddTyre(car, *wheel, plain.get(), body);
    else
      AddCollision(spec, link, plain.get(), carrier);
  }
}

}  // namespace merlin::sim::car_body
