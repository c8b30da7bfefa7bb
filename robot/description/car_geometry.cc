#include "robot/description/car_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "robot/types/error.h"

namespace merlin {
namespace {

constexpr std::array kWheels = {"front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"};
constexpr std::array kSteeredLinks = {"steering_servo", "front_left_knuckle", "front_right_knuckle"};
constexpr double kSameLength_m = 1e-6;  // lengths in the file closer than this are the same

// The car's links with their poses in the base frame, joints at 0.
class Tree {
 public:
  Tree(const UrdfSource& source, const std::vector<CarLink>& links) : source_(source) {
    for (const CarLink& link : links) {
      const Pose T_base_parent = link.parent.empty() ? Pose::Identity() : nodes_.at(link.parent).T_base_link;
      nodes_.emplace(link.name, Node{&link, T_base_parent * link.T_parent_link});
    }
  }
  const CarLink& Link(const std::string& name) const { return *Find(name).link; }
  Pose T_base(const std::string& name) const { return Find(name).T_base_link; }

 private:
  struct Node {
    const CarLink* link;
    Pose T_base_link;
  };
  const Node& Find(const std::string& name) const {
    const auto node = nodes_.find(name);
    if (node == nodes_.end()) throw InputError(source_.path.string(), fmt::format("the car needs a link '{}'", name));
    return node->second;
  }
  const UrdfSource& source_;
  std::map<std::string, Node> nodes_;
};

double WheelRadius(const UrdfSource& source, const CarLink& wheel) {
  if (wheel.joint != CarLink::Joint::kContinuous)
    throw InputError(source.Where(wheel.joint_name), fmt::format("'{}' must turn", wheel.name), "a continuous joint");
  if (wheel.collision.size() != 1 || wheel.collision[0].kind != CarShape::Kind::kCylinder)
    throw InputError(source.Where(wheel.name), fmt::format("'{}': the tyre", wheel.name), "one collision cylinder");
  if (!(wheel.mass_kg > 0.0)) throw InputError(source.Where(wheel.name), fmt::format("'{}' needs a mass", wheel.name));
  return wheel.collision[0].size_m.x();
}

// Wheelbase, track, radius and the largest steering angle; the four wheels must agree on them.
void DeriveWheels(const UrdfSource& source, const Tree& tree, CarDescription& car) {
  const Eigen::Vector3d front_left = tree.T_base(kWheels[0]).translation();
  const Eigen::Vector3d rear_left = tree.T_base(kWheels[2]).translation();
  car.wheel_radius_m = WheelRadius(source, tree.Link(kWheels[0]));
  car.wheelbase_m = front_left.x() - rear_left.x();
  car.track_m = 2.0 * front_left.y();
  if (!(car.wheelbase_m > 0.0 && car.track_m > 0.0))
    throw InputError(source.Where(kWheels[0]), "wheelbase and track", "positive lengths",
                     fmt::format("{} m and {} m", car.wheelbase_m, car.track_m));
  for (const std::string wheel : kWheels) {
    const Eigen::Vector3d expected(wheel.starts_with("front") ? car.wheelbase_m : 0.0,
                                   (wheel.find("left") != std::string::npos ? 0.5 : -0.5) * car.track_m,
                                   car.wheel_radius_m);
    const Eigen::Vector3d centre = tree.T_base(wheel).translation();
    if ((centre - expected).norm() > kSameLength_m)
      throw InputError(source.Where(wheel),
                       fmt::format("'{}': base_link lies on the ground below the rear axle's middle", wheel),
                       fmt::format("its centre at ({}, {}, {}) m", expected.x(), expected.y(), expected.z()),
                       fmt::format("({}, {}, {}) m", centre.x(), centre.y(), centre.z()));
    if (std::abs(WheelRadius(source, tree.Link(wheel)) - car.wheel_radius_m) > kSameLength_m)
      throw InputError(source.Where(wheel), fmt::format("'{}': radius", wheel),
                       fmt::format("{} m as the others", car.wheel_radius_m));
  }
  for (const std::string link : kSteeredLinks)
    if (tree.Link(link).joint != CarLink::Joint::kRevolute)
      throw InputError(source.Where(tree.Link(link).joint_name), fmt::format("'{}' must steer", link),
                       "a revolute joint");
  car.steering_max_rad =
      std::min(-tree.Link("steering_servo").joint_min_rad, tree.Link("steering_servo").joint_max_rad);
  if (!(car.steering_max_rad > 0.0 && car.steering_max_rad < 1.5))
    throw InputError(source.Where(tree.Link("steering_servo").joint_name), "steering limits",
                     "both sides of 0, below 1.5 rad");
}

}  // namespace

Drivetrain ReadDrivetrain(const UrdfSource& source) {
  const TiXmlElement* element = source.document.RootElement()->FirstChildElement("drivetrain");
  if (element == nullptr)
    throw InputError(source.path.string(), "the car needs an element <drivetrain .../> under <robot>");
  const std::string where = fmt::format("{}:{}", source.path.string(), element->Row());
  const auto positive = [&](const char* name) {
    double value = 0.0;
    const int status = element->QueryDoubleAttribute(name, &value);
    if (status == TIXML_NO_ATTRIBUTE) throw InputError(where, fmt::format("<drivetrain> needs '{}'", name));
    if (status != TIXML_SUCCESS || !(value > 0.0) || !std::isfinite(value))
      throw InputError(where, fmt::format("<drivetrain> '{}'", name), "a positive number", element->Attribute(name));
    return value;
  };
  Drivetrain d;
  d.gear = positive("gear");
  const double counts = positive("encoder_counts_per_motor_turn");
  if (counts != std::floor(counts) || counts > 1e6)
    throw InputError(where, "<drivetrain> 'encoder_counts_per_motor_turn'", "a whole number up to 1000000",
                     fmt::format("{}", counts));
  d.encoder_counts_per_motor_turn = static_cast<int>(counts);
  d.motor_constant_v_s = positive("motor_constant_v_s");
  d.resistance_ohm = positive("resistance_ohm");
  d.rotor_inertia_kg_m2 = positive("rotor_inertia_kg_m2");
  d.voltage_max_v = positive("voltage_max_v");
  d.speed_max_m_s = positive("speed_max_m_s");
  d.acceleration_max_m_s2 = positive("acceleration_max_m_s2");
  d.steering_slew_rad_s = positive("steering_slew_rad_s");
  d.tyre_friction = positive("tyre_friction");
  return d;
}

void DeriveGeometry(const UrdfSource& source, CarDescription& car) {
  const Tree tree(source, car.links);
  DeriveWheels(source, tree, car);
  car.T_base_depth = tree.T_base("depth_camera_optical_frame");
  car.T_base_color = tree.T_base("color_camera_optical_frame");
  car.T_base_compass = tree.T_base("compass_frame");
}

}  // namespace merlin
