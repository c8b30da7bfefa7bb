#include "robot/types/footprint.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace merlin {
namespace {

struct Extent {
  Eigen::Vector3d middle_base{0, 0, 0};
  Eigen::Vector3d reach{0, 0, 0};  // to either side
};

Extent MeshExtent(const CarShape& shape, const Pose& T_base_shape) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : shape.mesh->vertices)
    box.extend(T_base_shape * shape.size_m.cwiseProduct(vertex.cast<double>()));
  return {box.center(), 0.5 * box.sizes()};
}

std::vector<Extent> ExtentsOf(const CarDescription& car) {
  std::vector<Extent> extents;
  std::map<std::string, Pose> T_base_link;
  for (const CarLink& link : car.links) {
    const auto parent = T_base_link.find(link.parent);
    const Pose T = parent == T_base_link.end() ? Pose::Identity() : parent->second * link.T_parent_link;
    T_base_link[link.name] = T;
    for (const CarShape& shape : link.collision) {
      if (shape.kind == CarShape::Kind::kMesh) {
        extents.push_back(MeshExtent(shape, T * shape.T_link_shape));
        continue;
      }
      Eigen::Vector3d half = 0.5 * shape.size_m;
      if (shape.kind == CarShape::Kind::kSphere) half.setConstant(shape.size_m.x());
      if (shape.kind == CarShape::Kind::kCylinder) half = {shape.size_m.x(), shape.size_m.x(), 0.5 * shape.size_m.y()};
      const Pose T_base_shape = T * shape.T_link_shape;
      extents.push_back({T_base_shape.translation(), T_base_shape.linear().cwiseAbs() * half});
    }
  }
  return extents;
}

}  // namespace

Footprint FootprintOf(const CarDescription& car) {
  Footprint footprint;
  const std::vector<Extent> extents = ExtentsOf(car);
  for (const auto& [middle, reach] : extents) {
    footprint.front_m = std::max(footprint.front_m, middle.x() + reach.x());
    footprint.rear_m = std::max(footprint.rear_m, reach.x() - middle.x());
    footprint.half_width_m = std::max(footprint.half_width_m, std::abs(middle.y()) + reach.y());
  }
  for (const auto& [middle, reach] : extents)
    if (2.0 * reach.y() >= footprint.half_width_m)
      footprint.height_m = std::max(footprint.height_m, middle.z() + reach.z());
  return footprint;
}

}  // namespace merlin
