#include "robot/types/footprint.h"

#include <gtest/gtest.h>

namespace merlin {
namespace {

TEST(Footprint, ReachesToTheFarthestCollisionShapeInTheBaseFrame) {
  CarDescription car;
  car.links.resize(2);
  car.links[0].name = car.links[1].parent = "base_link";
  car.links[1].name = "nose";
  car.links[1].T_parent_link.translation() = Eigen::Vector3d(0.3, 0.0, 0.1);
  CarShape box;
  box.size_m = {0.2, 0.3, 0.1};
  box.T_link_shape.translation() = Eigen::Vector3d(0.05, 0.0, 0.0);
  car.links[1].collision.push_back(box);
  EXPECT_NEAR(FootprintOf(car).front_m, 0.45, 1e-12);
  EXPECT_EQ(FootprintOf(car).rear_m, 0.0);  // all of it is ahead of base_link
  EXPECT_NEAR(FootprintOf(car).half_width_m, 0.15, 1e-12);
  EXPECT_NEAR(FootprintOf(car).height_m, 0.15, 1e-12);
  box.size_m = {0.02, 0.02, 1.0};  // a mast
  car.links[1].collision.push_back(box);
  EXPECT_NEAR(FootprintOf(car).height_m, 0.15, 1e-12);
}

TEST(Footprint, ReachesBehindTheBase) {
  CarDescription car;
  car.links.resize(1);
  car.links[0].name = "base_link";
  CarShape box;
  box.size_m = {0.6, 0.3, 0.1};
  box.T_link_shape.translation() = Eigen::Vector3d(0.18, 0.0, 0.0);
  car.links[0].collision.push_back(box);
  EXPECT_NEAR(FootprintOf(car).rear_m, 0.12, 1e-12);
  EXPECT_NEAR(FootprintOf(car).front_m, 0.48, 1e-12);
}

TEST(Footprint, ReachesOverMeshesToo) {
  CarDescription car;
  car.links.resize(1);
  car.links[0].name = "base_link";
  CarShape shape;
  shape.kind = CarShape::Kind::kMesh;
  shape.size_m = {0.1, 0.1, 0.1};
  shape.mesh = std::make_shared<CarMesh>(
      CarMesh{.vertices = {{-1, -2, 0}, {3, -2, 0}, {3, 1, 4}}, .triangles = {{0, 1, 2}}, .rgba = {}});
  shape.T_link_shape.translation() = Eigen::Vector3d(0.2, 0.0, 0.1);
  car.links[0].collision.push_back(shape);
  EXPECT_NEAR(FootprintOf(car).front_m, 0.5, 1e-7);
  EXPECT_NEAR(FootprintOf(car).half_width_m, 0.2, 1e-7);
  EXPECT_NEAR(FootprintOf(car).height_m, 0.5, 1e-7);
}

}  // namespace
}  // namespace merlin
