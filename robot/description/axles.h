// Where a car's wheels stand: its two axles, and the base's frame that follows from them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "robot/description/link_tree.h"
#include "robot/description/urdf_source.h"
#include "robot/types/car.h"

namespace merlin {

constexpr double kSameLength_m = 5e-4;  // lengths that differ by less are equal: numbers in files are rounded
constexpr double kParallel = 0.99;      // cosine of two directions that are the same

// The middles of the wheels: front left, front right, rear left, rear right.
using Middles = std::array<Eigen::Vector3d, 4>;

std::string PointText(const Eigen::Vector3d& p);

// How far an axle is from symmetric about the base's xz plane: the distance of its mirrored left wheel from its right
// one.
double OffSymmetry_m(const Eigen::Vector3d& left_base, const Eigen::Vector3d& right_base);

// Whether that is too much for one axle. Below the limit, the mean of left and right is used.
bool IsLopsided(double off_m);
std::string MostOffText();  // "less than 5 mm off symmetry"

// Collects the axles that are slightly asymmetric, for one common warning.
class Asymmetry {
 public:
  void Add(const std::string& what, double off_m);
  void Warn(const UrdfSource& source, CarDescription& car) const;

 private:
  std::string text_;
};

// The base's frame in the root's: on the ground below the rear axle's middle, x ahead, y left, z up. Its y is along the
// rear axle, or along the front one if the wheels are more symmetric about that: one misplaced wheel turns the
// direction of its own axle, and must not turn the whole car. If the base is the root within rounding, it is the root
// exactly. Throws InputError for wheels that do not form two axles.
Pose BaseInRoot(const UrdfSource& source, const Middles& root, double radius_m);

// Sets wheelbase, track and the directions of the wheels' axes. Throws InputError unless the wheels form two axles,
// each symmetric about the base's x axis, with all wheels on the ground.
void DeriveWheels(const UrdfSource& source, LinkTree& tree, const Middles& middles_root, const Pose& T_base_root,
                  CarDescription& car, Asymmetry& asymmetry);

}  // namespace merlin
