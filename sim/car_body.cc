#include "sim/car_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "sim/spec.h"

namespace merlin::sim::car_body {
namespace {

void SetPose(const Pose& pose, double pos[3], double quat[4]) {
  const Eigen::Quaterniond q(pose.linear());
  Eigen::Vector3d::Map(pos) = pose.translation();
  quat[0] = q.w(), quat[1] = q.x(), quat[2] = q.y(), quat[3] = q.z();
}

void SetInertial(const CarLink& link, mjsBody* body) {
  // ipos is NaN until it is set, and mass would be ignored in favour of the geoms' without explicitinertial.
  body->mass = link.mass_kg;
  Eigen::Vector3d::Map(body->ipos) = link.T_link_inertial.translation();
  const Eigen::Matrix3d rotation = link.T_link_inertial.linear();
  const Eigen::Matrix3d inertia = rotation * link.inertia_kg_m2 * rotation.transpose();
  const double full[6] = {inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2)};
  if (link.mass_kg > 0.0) std::copy(full, full + 6, body->fullinertia);
  body->explicitinertial = 1;
}

void AddJoint(const mjSpec* spec, const CarDescription& car, const CarLink& link, const mjsDefault* plain,
              mjsBody* body) {
  if (link.joint == CarLink::Joint::kFixed) return;
  mjsJoint* joint = mjs_addJoint(body, plain);
  SetName(joint->element, link.joint_name);
  joint->type = mjJNT_HINGE;
  Eigen::Vector3d::Map(joint->axis) = link.axis;
  joint->limited = mjLIMITED_FALSE;
  if (link.joint == CarLink::Joint::kRevolute) {
    const double unit =
        spec->compiler.degree ? 180.0 / std::numbers::pi : 1.0;  // the room's choice rules the whole spec
    joint->limited = mjLIMITED_TRUE;
    joint->range[0] = link.joint_min_rad * unit;
    joint->range[1] = link.joint_max_rad * unit;
  }
  // A quarter of the rotor for each wheel: behind ideal differentials the motor turns with the mean of the four, and
  // MuJoCo takes only the diagonal of an inertia set on the motor or tendon.
  if (IsWheel(link))
    joint->armature = car.drivetrain.rotor_inertia_kg_m2 * car.drivetrain.gear * car.drivetrain.gear / 4.0;
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
  mjsMesh* mesh = mjs_addMesh(spec, plain);
  SetName(mesh->element, name);
  mjs_setString(mesh->file, shape.mesh.c_str());
  Eigen::Vector3d::Map(mesh->scale) = shape.size_m;
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

// Values found to roll truly: circles within 0.1 % of Ackermann's radius, no drift at rest.
void MakeTyre(const CarDescription& car, mjsGeom* geom) {
  geom->type = mjGEOM_ELLIPSOID;
  const double radius_m = geom->size[0], half_width_m = geom->size[1];
  geom->size[0] = geom->size[1] = radius_m, geom->size[2] = half_width_m;
  geom->condim = 3;    // no torsional friction: a tyre steered on the spot would fight it
  geom->priority = 1;  // else the larger friction of the pair would count, and a floor's default is 1
  geom->friction[0] = car.drivetrain.tyre_friction;
  geom->solref[0] = 0.01, geom->solref[1] = 1.0;
  geom->solimp[0] = 0.95, geom->solimp[1] = 0.99, geom->solimp[2] = 0.001;
}

// The body whose part a link is when it meets the room: its own if it moves against its parent, else the one it is fixed
// to. Six bodies to hold against every wall instead of a dozen: physics alone is a quarter faster.
struct Carrier {
  mjsBody* body;
  Pose T_carrier_link;
};

void AddShapes(mjSpec* spec, const CarDescription& car, const CarLink& link, const mjsDefault* plain, mjsBody* body,
               const Carrier& carrier) {
  for (std::size_t i = 0; i < link.visual.size(); ++i) {
    mjsGeom* geom = AddShape(spec, link.visual[i], fmt::format("{}_visual_{}", link.name, i), plain, body);
    geom->group = kVisualGroup;
    geom->contype = geom->conaffinity = 0;
    SetMaterial(spec, link.visual[i], plain, geom);
  }
  for (std::size_t i = 0; i < link.collision.size(); ++i) {
    CarShape shape = link.collision[i];
    shape.T_link_shape = carrier.T_carrier_link * shape.T_link_shape;
    mjsGeom* geom = AddShape(spec, shape, fmt::format("{}_collision_{}", link.name, i), plain, carrier.body);
    geom->group = kCollisionGroup;
    geom->contype = 2,
    geom->conaffinity = 1;  // meets the room (1, 1), never the car itself: wheels may steer past the chassis
    if (IsWheel(link)) MakeTyre(car, geom);
  }
}

}  // namespace

bool IsWheel(const CarLink& link) { return link.joint == CarLink::Joint::kContinuous; }

void AddTo(mjSpec* spec, const CarDescription& car, const Pose& T_world_base) {
  const BuiltinDefaults plain;
  std::map<std::string, Carrier> carriers;
  for (const CarLink& link : car.links) {
    mjsBody* body = mjs_addBody(mjs_findBody(spec, link.parent.empty() ? "world" : link.parent.c_str()), plain.get());
    SetName(body->element, link.name);
    if (link.parent.empty()) {
      SetPose(T_world_base, body->pos, body->quat);
      mjsJoint* joint = mjs_addFreeJoint(body);
      joint->align = mjALIGNFREE_FALSE;  // qpos is base_link's pose, not that of the centre of mass
      SetName(joint->element, "car");
    } else {
      SetPose(link.T_parent_link, body->pos, body->quat);
      AddJoint(spec, car, link, plain.get(), body);
    }
    Carrier carrier{body, Pose::Identity()};
    if (link.joint == CarLink::Joint::kFixed && !link.parent.empty()) {
      carrier = carriers.at(link.parent);
      carrier.T_carrier_link = carrier.T_carrier_link * link.T_parent_link;
    }
    carriers.emplace(link.name, carrier);
    SetInertial(link, body);
    AddShapes(spec, car, link, plain.get(), body, carrier);
  }
}

}  // namespace merlin::sim::car_body
