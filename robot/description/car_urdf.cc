#include <fmt/format.h>
#include <urdf_model/model.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <map>
#include <memory>
#include <tuple>

#include "robot/base/error.h"
#include "robot/description/car_geometry.h"
#include "robot/description/car_mapping.h"
#include "robot/description/description.h"
#include "robot/description/mesh_file.h"
#include "robot/description/mesh_path.h"
#include "robot/description/urdf_check.h"
#include "robot/description/urdf_source.h"

namespace merlin {
namespace {

constexpr double kInertiaRounding = 1e-4;  // relative, that files with few digits need
constexpr double kMassMin = 1e-14;         // kg, and kg m2: MuJoCo treats less as zero

Pose ToPose(const urdf::Pose& pose) {
  const auto& [x, y, z, w] = pose.rotation;
  Pose result = Pose::Identity();
  result.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

// All in one plane, to a millionth of its extent.
bool IsFlat(const CarMesh& mesh) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    middle += vertex.cast<double>() / static_cast<double>(mesh.vertices.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    spread += (vertex.cast<double>() - middle) * (vertex.cast<double>() - middle).transpose();
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
  return !(moments[0] > 1e-12 * moments[2]);
}

// The scale of a mesh may be negative along an axis, which mirrors it.
CarShape ToShape(const UrdfSource& source, const std::string& link, const urdf::Geometry* geometry,
                 const urdf::Pose& origin) {
  CarShape shape;
  shape.T_link_shape = ToPose(origin);
  bool positive = true;
  if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) {
    shape.kind = CarShape::Kind::kBox;
    shape.size_m = {box->dim.x, box->dim.y, box->dim.z};
    positive = (shape.size_m.array() > 0.0).all();
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(geometry)) {
    shape.kind = CarShape::Kind::kCylinder;
    shape.size_m = {cylinder->radius, cylinder->length, 0.0};
    positive = cylinder->radius > 0.0 && cylinder->length > 0.0;
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(geometry)) {
    shape.kind = CarShape::Kind::kSphere;
    shape.size_m = {sphere->radius, 0.0, 0.0};
    positive = sphere->radius > 0.0;
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(geometry)) {
    shape.kind = CarShape::Kind::kMesh;
    shape.size_m = {mesh->scale.x, mesh->scale.y, mesh->scale.z};
    positive = (shape.size_m.array() != 0.0).all();
    shape.mesh_file = FindMesh(source.path, mesh->filename, source.Where(link), link);
  }
  if (!positive)
    throw InputError(source.Where(link), fmt::format("link '{}': size of a shape", link),
                     shape.kind == CarShape::Kind::kMesh ? "a scale that is nowhere 0" : "positive numbers",
                     fmt::format("{} {} {}", shape.size_m.x(), shape.size_m.y(), shape.size_m.z()));
  return shape;
}

// The principal moments of a body are positive, and none exceeds the sum of the other two. Rounding can break this for
// thin plates. The largest is then lowered to that sum, because MuJoCo accepts no excess.
Eigen::Matrix3d BalancedInertia(const UrdfSource& source, const std::string& link, const Eigen::Matrix3d& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  Eigen::Vector3d moments = solver.eigenvalues();
  const double sum = moments[0] + moments[1];
  if (!(moments[0] > kMassMin))
    throw InputError(source.Where(link), fmt::format("link '{}': smallest principal inertia", link),
                     "a positive number of kg m2", fmt::format("{}", moments[0]));
  if (moments[2] > sum * (1.0 + kInertiaRounding))
    throw InputError(source.Where(link), fmt::format("link '{}': largest principal inertia", link),
                     fmt::format("at most the sum {} of the others", sum), fmt::format("{}", moments[2]));
  if (moments[2] <= sum) return inertia;
  moments[2] = sum * (1.0 - 1e-9);
  return solver.eigenvectors() * moments.asDiagonal() * solver.eigenvectors().transpose();
}

void ReadInertial(const UrdfSource& source, const urdf::Inertial& inertial, CarLink& link) {
  link.mass_kg = inertial.mass;
  if (!(link.mass_kg > kMassMin))
    throw InputError(source.Where(link.name), fmt::format("link '{}': mass", link.name), "a positive number of kg",
                     fmt::format("{}", link.mass_kg));
  link.T_link_inertial = ToPose(inertial.origin);
  Eigen::Matrix3d inertia;
  inertia << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz, inertial.ixz,
      inertial.iyz, inertial.izz;
  link.inertia_kg_m2 = BalancedInertia(source, link.name, inertia);
}

void ReadJoint(const UrdfSource& source, const urdf::Joint& joint, CarLink& link) {
  link.joint_name = joint.name;
  link.parent = joint.parent_link_name;
  link.T_parent_link = ToPose(joint.parent_to_joint_origin_transform);
  switch (joint.type) {
    case urdf::Joint::FIXED:
      link.joint = CarLink::Joint::kFixed;
      return;
    case urdf::Joint::REVOLUTE:
      link.joint = CarLink::Joint::kRevolute;
      link.joint_min_rad = joint.limits->lower;
      link.joint_max_rad = joint.limits->upper;
      link.joint_speed_max_rad_s = joint.limits->velocity;
      if (!(link.joint_min_rad < link.joint_max_rad))
        throw InputError(source.Where(joint.name), fmt::format("joint '{}': limits", joint.name), "lower < upper");
      break;
    case urdf::Joint::CONTINUOUS:
      link.joint = CarLink::Joint::kContinuous;
      break;
    case urdf::Joint::PRISMATIC:
      link.joint = CarLink::Joint::kPrismatic;
      break;
    default:
      assert(false);  // CheckUrdf refuses the others
  }
  link.axis = {joint.axis.x, joint.axis.y, joint.axis.z};
  if (!(link.axis.norm() > 0.0))
    throw InputError(source.Where(joint.name), fmt::format("joint '{}': axis is zero", joint.name));
  link.axis.normalize();
}

// The mesh with its axes multiplied by these signs. An odd number of negative signs mirrors it; the corners of each
// triangle are then swapped, so that surfaces still face outwards.
CarMesh Mirrored(CarMesh mesh, const Eigen::Vector3f& signs) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = vertex.cwiseProduct(signs);
  if (signs.prod() < 0.0f)
    for (Eigen::Vector3i& corners : mesh.triangles) std::swap(corners[1], corners[2]);
  return mesh;
}

// Reads each mesh file once for each way of mirroring it. Wheels share their mesh.
class MeshFiles {
 public:
  using Parts = std::vector<std::shared_ptr<const CarMesh>>;

  explicit MeshFiles(const FaultList& faults) : faults_(faults) {}

  // The parts for this shape, mirrored by the signs of its scale; the scale itself becomes positive. Empty once there
  // are faults, because no car is built then.
  const Parts& Of(CarShape& shape) {
    static const Parts kNone;
    if (!faults_.empty()) return kNone;
    const Eigen::Vector3d signs = (shape.size_m.array() < 0.0).select(-1.0, Eigen::Vector3d::Ones());
    shape.size_m = shape.size_m.cwiseAbs();
    const auto [entry, is_new] = parts_.try_emplace(Key{shape.mesh_file, signs.x(), signs.y(), signs.z()});
    if (is_new) entry->second = Read(shape.mesh_file, signs.cast<float>());
    return entry->second;
  }

 private:
  using Key = std::tuple<std::filesystem::path, double, double, double>;

  static Parts Read(const std::filesystem::path& file, const Eigen::Vector3f& signs) {
    Parts parts;
    for (CarMesh& part : ReadMesh(file))
      parts.push_back(std::make_shared<const CarMesh>(Mirrored(std::move(part), signs)));
    return parts;
  }

  const FaultList& faults_;
  std::map<Key, Parts> parts_;
};

// A mesh of several colours becomes one shape for each colour. A material in the URDF overrides all of them.
void AddVisual(const UrdfSource& source, const urdf::Visual& visual, MeshFiles& meshes, CarLink& link) {
  CarShape shape = ToShape(source, link.name, visual.geometry.get(), visual.origin);
  shape.material = visual.material_name;
  if (visual.material) {
    const urdf::Color& color = visual.material->color;
    shape.rgba = {color.r, color.g, color.b, color.a};
  }
  if (shape.kind != CarShape::Kind::kMesh) return link.visual.push_back(shape);
  for (const auto& part : meshes.Of(shape)) {
    if (!visual.material && part->rgba) shape.rgba = *part->rgba;
    shape.mesh = part;
    link.visual.push_back(shape);
  }
}

// Contact uses the convex hull of a mesh, so the mesh must enclose a volume.
void AddCollision(const UrdfSource& source, const urdf::Collision& collision, MeshFiles& meshes, CarLink& link) {
  CarShape shape = ToShape(source, link.name, collision.geometry.get(), collision.origin);
  if (shape.kind == CarShape::Kind::kMesh) {
    const MeshFiles::Parts& parts = meshes.Of(shape);
    if (parts.empty()) return;
    shape.mesh = std::make_shared<const CarMesh>(Joined(parts));
    if (IsFlat(*shape.mesh))
      throw InputError(
          source.Where(link.name),
          fmt::format("link '{}': collision mesh {} is flat", link.name, shape.mesh_file.filename().string()),
          "a solid");
  }
  link.collision.push_back(shape);
}

CarLink ToLink(const UrdfSource& source, const urdf::Link& from, MeshFiles& meshes, UrdfFaults& faults) {
  CarLink link;
  link.name = from.name;
  if (from.parent_joint && !faults.parts.contains(from.parent_joint->name))
    faults.list.Try([&] { ReadJoint(source, *from.parent_joint, link); });
  if (faults.parts.contains(from.name)) return link;
  if (from.inertial) faults.list.Try([&] { ReadInertial(source, *from.inertial, link); });
  for (const auto& visual : from.visual_array) faults.list.Try([&] { AddVisual(source, *visual, meshes, link); });
  for (const auto& collision : from.collision_array)
    faults.list.Try([&] { AddCollision(source, *collision, meshes, link); });
  return link;
}

// Parents before children, siblings in the order of the file.
void AppendTree(const UrdfSource& source, const urdf::Link& link, MeshFiles& meshes, UrdfFaults& faults,
                std::vector<CarLink>& links) {
  links.push_back(ToLink(source, link, meshes, faults));
  std::vector<urdf::LinkSharedPtr> children = link.child_links;
  std::ranges::stable_sort(children, {}, [&source](const auto& child) { return source.Line(child->name); });
  for (const auto& child : children) AppendTree(source, *child, meshes, faults, links);
}

// The model; null if the faults already say why there is none.
urdf::ModelInterfaceSharedPtr ParseUnless(const UrdfFaults& faults, const UrdfSource& source) {
  try {
    return ParseUrdf(source);
  } catch (const InputError&) {
    if (faults.list.empty()) throw;
    return nullptr;
  }
}

}  // namespace

CarDescription ReadCar(const std::filesystem::path& urdf) {
  const UrdfSource source = ReadUrdf(urdf);
  UrdfFaults faults;
  CheckUrdf(source, faults);
  CarDescription car;
  car.file = urdf;
  if (const urdf::ModelInterfaceSharedPtr model = ParseUnless(faults, source)) {
    car.name = model->getName();
    MeshFiles meshes(faults.list);
    AppendTree(source, *model->getRoot(), meshes, faults, car.links);
  }
  faults.list.ThrowIfAny();
  const CarMapping mapping = ReadMapping(urdf);
  DeriveGeometry(source, mapping, car);
  car.drivetrain = mapping.drivetrain ? *mapping.drivetrain : ReadDrivetrain(source);
  return car;
}

}  // namespace merlin
