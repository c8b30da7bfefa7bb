#include "robot/description/axles.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "robot/base/error.h"

namespace merlin {
namespace {

constexpr double kSymmetric_m = 1e-4;  // an axle less asymmetric than this counts as symmetric
constexpr double kLopsided_m = 5e-3;   // one more asymmetric is refused; in between, the mean is used

double FrontOff_m(const Middles& base) { return OffSymmetry_m(base[0], base[1]); }
double RearOff_m(const Middles& base) { return OffSymmetry_m(base[2], base[3]); }

Middles Transformed(const Pose& T, const Middles& middles) {
  return {T * middles[0], T * middles[1], T * middles[2], T * middles[3]};
}

// The base frame: on the ground below the rear axle's middle, y along `left`, x towards the front axle.
Pose BaseAlong(const Eigen::Vector3d& left, const Middles& root, double radius_m) {
  const Eigen::Vector3d rear = 0.5 * (root[2] + root[3]), front = 0.5 * (root[0] + root[1]);
  const Eigen::Vector3d ahead = (front - rear - left * left.dot(front - rear)).normalized();
  Pose T_root_base = Pose::Identity();
  T_root_base.linear() << ahead, left, ahead.cross(left);
  T_root_base.translation() = rear - radius_m * T_root_base.linear().col(2);
  return T_root_base;
}

}  // namespace

std::string PointText(const Eigen::Vector3d& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z());
}

double OffSymmetry_m(const Eigen::Vector3d& left_base, const Eigen::Vector3d& right_base) {
  return (left_base.cwiseProduct(Eigen::Vector3d(1, -1, 1)) - right_base).norm();
}

bool IsLopsided(double off_m) { return !(off_m < kLopsided_m - 1e-9); }  // numbers in files are rounded

std::string MostOffText() { return fmt::format("less than {:g} mm off symmetry", 1e3 * kLopsided_m); }

void Asymmetry::Add(const std::string& what, double off_m) {
  if (off_m > kSymmetric_m) text_ += fmt::format("{}{} by {:.2f} mm", text_.empty() ? "" : ", ", what, 1e3 * off_m);
}

void Asymmetry::Warn(const UrdfSource& source, CarDescription& car) const {
  if (!text_.empty())
    car.warnings.push_back(
        fmt::format("{}: left and right are not symmetric: {}; the means of both sides are used (up to {:g} mm)",
                    source.path.string(), text_, 1e3 * kLopsided_m));
}

Pose BaseInRoot(const UrdfSource& source, const Middles& root, double radius_m) {
  const Eigen::Vector3d rear_axle = root[2] - root[3], front_axle = root[0] - root[1];
  const Eigen::Vector3d ahead = root[0] + root[1] - root[2] - root[3], left = rear_axle.normalized();
  if (!(rear_axle.norm() > kSameLength_m && front_axle.norm() > kSameLength_m &&
        (ahead - left * left.dot(ahead)).norm() > 2.0 * kSameLength_m))
    throw InputError(source.path.string(), "the wheels overlap", "two axles, one before the other");
  const auto off_m = [&root](const Pose& T_root_base) {
    const Middles base = Transformed(T_root_base.inverse(), root);
    return std::max(FrontOff_m(base), RearOff_m(base));
  };
  Pose T_root_base = BaseAlong(left, root, radius_m);
  const Pose by_front = BaseAlong(front_axle.normalized(), root, radius_m);
  if (off_m(by_front) < off_m(T_root_base) - kSymmetric_m) T_root_base = by_front;
  if (!(T_root_base.linear()(2, 2) > kParallel && front_axle.dot(rear_axle) > 0.0))
    throw InputError(source.path.string(), "the wheels do not stand as their roles say",
                     "the root's z up, left wheels on the left, front wheels in front");
  return T_root_base.isApprox(Pose::Identity(), 1e-6) ? Pose::Identity() : T_root_base;
}

void DeriveWheels(const UrdfSource& source, LinkTree& tree, const Middles& middles_root, const Pose& T_base_root,
                  CarDescription& car, Asymmetry& asymmetry) {
  const Middles middles = Transformed(T_base_root, middles_root);
  car.wheelbase_m = 0.5 * (middles[0].x() + middles[1].x());
  car.track_m = 0.5 * (middles[0].y() - middles[1].y() + middles[2].y() - middles[3].y());
  for (const std::size_t left : {0u, 2u}) {
    const CarLink& link = tree.Link(car.wheels[left].link);
    const double off_m = OffSymmetry_m(middles[left], middles[left + 1]);
    asymmetry.Add(left == 0 ? "the front wheels" : "the rear wheels", off_m);
    if (IsLopsided(off_m))
      throw InputError(
          source.Where(link.name), fmt::format("'{}': the wheels are not two axles of one car", link.name),
          fmt::format("it and '{}' {} about the car's middle", tree.Link(car.wheels[left + 1].link).name,
                      MostOffText()),
          fmt::format("{:.6g} mm: {} and {}", 1e3 * off_m, PointText(middles[left]), PointText(middles[left + 1])));
  }
  for (const CarWheel& wheel : car.wheels) {
    CarLink& link = tree.Link(wheel.link);
    const double along = (T_base_root.linear() * tree.AxisInRoot(wheel.link)).y();
    if (std::abs(along) < kParallel)
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}': axis", link.joint_name),
                       "the axle's direction");
    if (along < 0.0) link.axis = -link.axis;
  }
}

}  // namespace merlin
