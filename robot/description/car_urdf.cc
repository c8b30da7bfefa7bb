#include <fmt/format.h>
#include <urdf_model/model.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "robot/description/car_geometry.h"
#include "robot/description/car_mapping.h"
#include "robot/description/description.h"
#include "robot/description/mesh_file.h"
#include "robot/description/urdf_source.h"
#include "robot/types/error.h"

namespace merlin {
namespace {

Pose ToPose(const urdf::Pose& pose) {
  const auto& [x, y, z, w] = pose.rotation;
  Pose result = Pose::Identity();
  result.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

// "package://<name>/x" and relative paths stand for x in the URDF's own folder.
std::filesystem::path MeshPath(const UrdfSource& source, const std::string& link, std::string name) {
  const std::string package = "package://", file = "file://";
  if (name.starts_with(package)) {
    const std::size_t slash = name.find('/', package.size());
    name = slash == std::string::npos ? "" : name.substr(slash + 1);
  } else if (name.starts_with(file)) {
    name = name.substr(file.size());
  }
  const std::filesystem::path path = std::filesystem::absolute(source.path).parent_path() / name;
  if (!std::filesystem::is_regular_file(path))
    throw InputError(source.Where(link), fmt::format("link '{}': missing mesh", link), "a file " + path.string());
  return path.lexically_normal();
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

CarShape ToShape(const UrdfSource& source, const std::string& link, const urdf::Geometry* geometry,
                 const urdf::Pose& origin) {
  if (geometry == nullptr) throw InputError(source.Where(link), fmt::format("link '{}': shape without geometry", link));
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
    positive = (shape.size_m.array() > 0.0).all();
    shape.mesh_file = MeshPath(source, link, mesh->filename);
  }
  if (!positive || !shape.size_m.allFinite())
    throw InputError(source.Where(link), fmt::format("link '{}': size of a shape", link), "positive numbers",
                     fmt::format("{} {} {}", shape.size_m.x(), shape.size_m.y(), shape.size_m.z()));
  return shape;
}

void ReadInertial(const UrdfSource& source, const urdf::Inertial& inertial, CarLink& link) {
  const auto fail = [&](const std::string& what, const std::string& expected, double got) {
    throw InputError(source.Where(link.name), fmt::format("link '{}': {}", link.name, what), expected,
                     fmt::format("{}", got));
  };
  link.mass_kg = inertial.mass;
  if (!(link.mass_kg > 0.0) || !std::isfinite(link.mass_kg)) fail("mass", "a positive number of kg", link.mass_kg);
  link.T_link_inertial = ToPose(inertial.origin);
  link.inertia_kg_m2 << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz,
      inertial.ixz, inertial.iyz, inertial.izz;
  if (!link.inertia_kg_m2.allFinite()) fail("inertia", "finite numbers of kg m2", link.inertia_kg_m2.sum());
  // A body's principal moments are positive and none exceeds the sum of the other two.
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link.inertia_kg_m2).eigenvalues();
  if (!(moments[0] > 0.0)) fail("smallest principal inertia", "a positive number of kg m2", moments[0]);
  if (moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-4))
    fail("largest principal inertia", fmt::format("at most the sum {} of the others", moments[0] + moments[1]),
         moments[2]);
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
      throw InputError(source.Where(joint.name), fmt::format("joint '{}': type", joint.name),
                       "fixed, revolute, continuous or prismatic: the car is one piece");
  }
  link.axis = {joint.axis.x, joint.axis.y, joint.axis.z};
  if (!(link.axis.norm() > 0.0))
    throw InputError(source.Where(joint.name), fmt::format("joint '{}': axis is zero", joint.name));
  link.axis.normalize();
}

// What is in each mesh file; wheels share theirs.
class MeshFiles {
 public:
  const std::vector<std::shared_ptr<const CarMesh>>& Parts(const std::filesystem::path& file) {
    const auto [entry, is_new] = parts_.try_emplace(file);
    if (is_new)
      for (CarMesh& part : ReadMesh(file)) entry->second.push_back(std::make_shared<const CarMesh>(std::move(part)));
    return entry->second;
  }

 private:
  std::map<std::filesystem::path, std::vector<std::shared_ptr<const CarMesh>>> parts_;
};

// A mesh of several colours is as many shapes; a material in the URDF paints them all.
void AddVisual(const UrdfSource& source, const urdf::Visual& visual, MeshFiles& meshes, CarLink& link) {
  CarShape shape = ToShape(source, link.name, visual.geometry.get(), visual.origin);
  shape.material = visual.material_name;
  if (visual.material) {
    const urdf::Color& color = visual.material->color;
    shape.rgba = {color.r, color.g, color.b, color.a};
  }
  if (shape.kind != CarShape::Kind::kMesh) return link.visual.push_back(shape);
  for (const auto& part : meshes.Parts(shape.mesh_file)) {
    if (!visual.material && part->rgba) shape.rgba = *part->rgba;
    shape.mesh = part;
    link.visual.push_back(shape);
  }
}

// What touches is a mesh's convex hull: it must have a volume.
void AddCollision(const UrdfSource& source, const urdf::Collision& collision, MeshFiles& meshes, CarLink& link) {
  CarShape shape = ToShape(source, link.name, collision.geometry.get(), collision.origin);
  if (shape.kind == CarShape::Kind::kMesh) {
    shape.mesh = std::make_shared<const CarMesh>(Joined(meshes.Parts(shape.mesh_file)));
    if (IsFlat(*shape.mesh))
      throw InputError(
          source.Where(link.name),
          fmt::format("link '{}': collision mesh {} is flat", link.name, shape.mesh_file.filename().string()),
          "a solid");
  }
  link.collision.push_back(shape);
}

CarLink ToLink(const UrdfSource& source, const urdf::Link& from, MeshFiles& meshes) {
  CarLink link;
  link.name = from.name;
  if (from.parent_joint) ReadJoint(source, *from.parent_joint, link);
  if (from.inertial) ReadInertial(source, *from.inertial, link);
  for (const auto& visual : from.visual_array) AddVisual(source, *visual, meshes, link);
  for (const auto& collision : from.collision_array) AddCollision(source, *collision, meshes, link);
  return link;
}

// Parents before children, siblings in the order of the file.
void AppendTree(const UrdfSource& source, const urdf::Link& link, MeshFiles& meshes, std::vector<CarLink>& links) {
  links.push_back(ToLink(source, link, meshes));
  std::vector<urdf::LinkSharedPtr> children = link.child_links;
  std::stable_sort(children.begin(), children.end(), [&source](const auto& a, const auto& b) {
    return source.lines.at(a->name) < source.lines.at(b->name);
  });
  for (const auto& child : children) AppendTree(source, *child, meshes, links);
}

}  // namespace

CarDescription ReadCar(const std::filesystem::path& urdf) {
  const UrdfSource source = ReadUrdf(urdf);
  const urdf::ModelInterfaceSharedPtr model = ParseUrdf(source);
  CarDescription car;
  car.name = model->getName();
  MeshFiles meshes;
  AppendTree(source, *model->getRoot(), meshes, car.links);
  const CarMapping mapping = ReadMapping(urdf);
  DeriveGeometry(source, mapping, car);
  car.drivetrain = mapping.drivetrain ? *mapping.drivetrain : ReadDrivetrain(source);
  return car;
}

}  // namespace merlin
