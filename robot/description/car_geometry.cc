#include "robot/description/car_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "robot/base/nearest_name.h"
#include "robot/description/drivetrain_numbers.h"

namespace merlin {
namespace {

constexpr double kSameLength_m = 5e-4;       // lengths that differ by less are the same: files round
constexpr double kSymmetric_m = 1e-4;        // an axle that is off symmetry by less is symmetric ...
constexpr double kLopsided_m = 5e-3;         // ... by this or more is none; between them its mean counts
constexpr double kParallel = 0.99;           // cosine of two directions that are the same
constexpr double kTrailMax = 0.02;           // of the wheelbase: a wheel's middle before or behind its steering axis
constexpr std::array kSides = {+1.0, -1.0};  // left, right

using Middles = std::array<Eigen::Vector3d, 4>;  // of the wheels

std::string Text(const Eigen::Vector3d& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z()); }

// The links by name, with their poses in the root's frame at joint angles 0.
class Tree {
 public:
  Tree(const UrdfSource& source, std::vector<CarLink>& links) : source_(source), links_(links) {
    for (const CarLink& link : links) {
      parents_.push_back(link.parent.empty() ? 0 : FindLink(link.parent));
      T_root_link_.push_back(link.parent.empty() ? Pose::Identity()
                                                 : T_root_link_[parents_.back()] * link.T_parent_link);
    }
  }
  CarLink& Link(std::size_t index) { return links_[index]; }
  const Pose& T_root(std::size_t index) const { return T_root_link_[index]; }
  Eigen::Vector3d AxisInRoot(std::size_t index) const { return T_root_link_[index].linear() * links_[index].axis; }
  bool IsBelow(std::size_t index, std::size_t ancestor) const {
    while (index != ancestor && index != 0) index = parents_[index];
    return index == ancestor;
  }
  // The nearest of these links that it hangs on, or that it is.
  std::size_t HeadOf(std::size_t index, const std::set<std::size_t>& heads) const {
    while (!heads.contains(index)) index = parents_[index];
    return index;
  }
  bool Has(const RoleName& frame) const {
    return std::ranges::find(links_, frame.name, &CarLink::name) != links_.end();
  }
  std::size_t LinkOf(const RoleName& frame) const {
    return Find(frame, "link", [](const CarLink& link) { return link.name; });
  }
  std::size_t LinkBehind(const RoleName& joint) const {
    return Find(joint, "joint", [](const CarLink& link) { return link.joint_name; });
  }

 private:
  std::size_t FindLink(const std::string& name) const {
    return static_cast<std::size_t>(std::ranges::find(links_, name, &CarLink::name) - links_.begin());
  }
  template <class NameOf>
  std::size_t Find(const RoleName& role, const std::string& kind, NameOf name_of) const {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      known.push_back(name_of(links_[i]));
      if (!known.back().empty() && known.back() == role.name) return i;
    }
    std::erase(known, "");
    const std::string nearest = NearestName(role.name, known);
    const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
    if (!role.where.empty())
      throw InputError(role.where, fmt::format("'{}' names {} '{}', which is not in {}{}", role.role, kind, role.name,
                                               source_.path.filename().string(), hint));
    throw InputError(source_.path.string(),
                     fmt::format("the car needs a {} '{}', or another that {} names for it{}", kind, role.name,
                                 MappingFile(source_.path).filename().string(), hint));
  }

  const UrdfSource& source_;
  std::vector<CarLink>& links_;
  std::vector<std::size_t> parents_;
  std::vector<Pose> T_root_link_;
};

// What steers is revolute; the mapping may give the limits that a continuous joint has not, or narrower ones.
void LimitKnuckle(const UrdfSource& source, const CarMapping& mapping, CarLink& link) {
  if (link.joint == CarLink::Joint::kContinuous) {
    if (!mapping.steering_limit_rad)
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}' must steer", link.joint_name),
                       fmt::format("type revolute, with limits, or steering_limit_rad in {}",
                                   MappingFile(source.path).filename().string()));
    link.joint = CarLink::Joint::kRevolute;
    link.joint_min_rad = -HUGE_VAL, link.joint_max_rad = HUGE_VAL;
  }
  if (!mapping.steering_limit_rad) return;
  link.joint_min_rad = std::max(link.joint_min_rad, -*mapping.steering_limit_rad);
  link.joint_max_rad = std::min(link.joint_max_rad, *mapping.steering_limit_rad);
}

// One role for each joint, and each joint able to play it.
void FindRoles(const UrdfSource& source, const CarMapping& mapping, Tree& tree, CarDescription& car) {
  std::set<std::string> taken;
  const auto find = [&](const RoleName& role, CarLink::Joint kind, const char* must, const char* expected) {
    const std::size_t index = tree.LinkBehind(role);
    const CarLink& link = tree.Link(index);
    if (!taken.insert(role.name).second)
      throw InputError(role.where, fmt::format("'{}': joint '{}' already has another role", role.role, role.name));
    if (link.joint != kind)
      throw InputError(source.Where(role.name), fmt::format("joint '{}' must {}", role.name, must), expected);
    return index;
  };
  for (std::size_t i = 0; i < 4; ++i)
    car.wheels[i].link =
        find(mapping.wheel_joints[i], CarLink::Joint::kContinuous, "turn endlessly", "type continuous");
  for (std::size_t i = 0; i < 2; ++i) {
    LimitKnuckle(source, mapping, tree.Link(tree.LinkBehind(mapping.steer_joints[i])));
    car.knuckles[i] = find(mapping.steer_joints[i], CarLink::Joint::kRevolute, "steer", "type revolute, with limits");
    if (!tree.IsBelow(car.wheels[i].link, car.knuckles[i]))
      throw InputError(source.Where(mapping.wheel_joints[i].name),
                       fmt::format("joint '{}' does not hang on what steers it", mapping.wheel_joints[i].name),
                       fmt::format("a link below joint '{}'", mapping.steer_joints[i].name));
  }
}

// A wheel's tyre: where its middle is, and how large.
struct Tyre {
  Pose T_link_tyre = Pose::Identity();
  double radius_m = 0.0, width_m = 0.0;
};

// The frame at a point whose z is the axle.
Pose AtAxle(const Eigen::Vector3d& middle, const Eigen::Vector3d& axis) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  pose.translation() = middle;
  return pose;
}

// The size of a mesh about the axle: its farthest vertex, and its middle along the axle.
Tyre MeshTyre(const CarShape& shape, const Eigen::Vector3d& axis) {
  double radius_m = 0.0, nearest_m = HUGE_VAL, farthest_m = -HUGE_VAL;
  for (const Eigen::Vector3f& vertex : shape.mesh->vertices) {
    const Eigen::Vector3d point = shape.T_link_shape * shape.size_m.cwiseProduct(vertex.cast<double>());
    const double along_m = axis.dot(point);
    radius_m = std::max(radius_m, (point - along_m * axis).norm());
    nearest_m = std::min(nearest_m, along_m), farthest_m = std::max(farthest_m, along_m);
  }
  return {AtAxle(0.5 * (nearest_m + farthest_m) * axis, axis), radius_m, farthest_m - nearest_m};
}

// What the largest round thing among the shapes says. A cylinder must lie along the axle; a ball is round about all,
// and a mesh is taken for round.
std::optional<Tyre> RoundTyre(const std::vector<CarShape>& shapes, const Eigen::Vector3d& axis) {
  std::optional<Tyre> largest;
  for (const CarShape& shape : shapes) {
    Tyre tyre{shape.T_link_shape, shape.size_m.x(), shape.size_m.y()};
    if (shape.kind == CarShape::Kind::kBox) continue;
    if (shape.kind == CarShape::Kind::kCylinder && std::abs(shape.T_link_shape.linear().col(2).dot(axis)) < kParallel)
      continue;
    if (shape.kind == CarShape::Kind::kSphere)
      tyre = {AtAxle(shape.T_link_shape.translation(), axis), shape.size_m.x(), 2.0 * shape.size_m.x()};
    if (shape.kind == CarShape::Kind::kMesh) tyre = MeshTyre(shape, axis);
    if (!largest || tyre.radius_m > largest->radius_m) largest = tyre;
  }
  return largest;
}

// By the shapes that touch, else by those that are seen; what the mapping says goes before both.
Tyre FindTyre(const UrdfSource& source, const CarMapping& mapping, const CarLink& link) {
  std::optional<Tyre> tyre = RoundTyre(link.collision, link.axis);
  if (!tyre) tyre = RoundTyre(link.visual, link.axis);
  if (!tyre && mapping.wheel_radius_m && mapping.wheel_width_m) tyre = {AtAxle({0, 0, 0}, link.axis), 0.0, 0.0};
  if (!tyre)
    throw InputError(
        source.Where(link.name), fmt::format("'{}': how large the tyre is", link.name),
        fmt::format("a cylinder about the axle, a sphere or a mesh, or wheel_radius_m and wheel_width_m in {}",
                    MappingFile(source.path).filename().string()));
  if (mapping.wheel_radius_m) tyre->radius_m = *mapping.wheel_radius_m;
  if (mapping.wheel_width_m) tyre->width_m = *mapping.wheel_width_m;
  return *tyre;
}

// The wheels' radius and their middles in the root's frame.
Middles DeriveTyres(const UrdfSource& source, const CarMapping& mapping, Tree& tree, CarDescription& car) {
  Middles middles;
  for (std::size_t i = 0; i < 4; ++i) {
    CarWheel& wheel = car.wheels[i];
    const CarLink& link = tree.Link(wheel.link);
    const Tyre tyre = FindTyre(source, mapping, link);
    wheel.T_link_tyre = tyre.T_link_tyre, wheel.width_m = tyre.width_m;
    if (i == 0) car.wheel_radius_m = tyre.radius_m;
    if (!(std::abs(tyre.radius_m - car.wheel_radius_m) <= kSameLength_m))
      throw InputError(source.Where(link.name), fmt::format("'{}': radius of the tyre", link.name),
                       fmt::format("{:.6g} m as of '{}'", car.wheel_radius_m, tree.Link(car.wheels[0].link).name),
                       fmt::format("{:.6g} m", tyre.radius_m));
    const Eigen::Vector3d middle = wheel.T_link_tyre.translation();
    if ((middle - link.axis * link.axis.dot(middle)).norm() > kSameLength_m)
      throw InputError(source.Where(link.name), fmt::format("'{}': the tyre's middle", link.name),
                       "on its joint's axis", Text(middle) + " from the joint");
    middles[i] = tree.T_root(wheel.link) * middle;
  }
  return middles;
}

// How far an axle is from symmetric about the base's xz plane: its left wheel, mirrored, from its right one.
double OffSymmetry_m(const Eigen::Vector3d& left_base, const Eigen::Vector3d& right_base) {
  return (left_base.cwiseProduct(Eigen::Vector3d(1, -1, 1)) - right_base).norm();
}

double FrontOff_m(const Middles& base) { return OffSymmetry_m(base[0], base[1]); }
double RearOff_m(const Middles& base) { return OffSymmetry_m(base[2], base[3]); }

Middles Transformed(const Pose& T, const Middles& middles) {
  return {T * middles[0], T * middles[1], T * middles[2], T * middles[3]};
}

// The base on the ground below the rear axle's middle, y along `left`, x on to the front axle.
Pose BaseAlong(const Eigen::Vector3d& left, const Middles& root, double radius_m) {
  const Eigen::Vector3d rear = 0.5 * (root[2] + root[3]), front = 0.5 * (root[0] + root[1]);
  const Eigen::Vector3d ahead = (front - rear - left * left.dot(front - rear)).normalized();
  Pose T_root_base = Pose::Identity();
  T_root_base.linear() << ahead, left, ahead.cross(left);
  T_root_base.translation() = rear - radius_m * T_root_base.linear().col(2);
  return T_root_base;
}

// Its y is along the rear axle, or along the front one if all wheels stand more symmetrically about that: one wheel
// that is off turns its own axle, and must not turn the car. A base within rounding of the root is the root.
Pose BaseInRoot(const UrdfSource& source, const Middles& root, double radius_m) {
  const Eigen::Vector3d rear_axle = root[2] - root[3], front_axle = root[0] - root[1];
  const Eigen::Vector3d ahead = root[0] + root[1] - root[2] - root[3], left = rear_axle.normalized();
  if (!(rear_axle.norm() > kSameLength_m && front_axle.norm() > kSameLength_m &&
        (ahead - left * left.dot(ahead)).norm() > 2.0 * kSameLength_m))
    throw InputError(source.path.string(), "the wheels stand in one another", "two axles, one before the other");
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

void PutBaseAboveRoot(const Pose& T_base_root, CarDescription& car) {
  CarLink base;
  base.name = "base_link";
  while (std::ranges::find(car.links, base.name, &CarLink::name) != car.links.end()) base.name += "_";
  car.links[0].parent = base.name;
  car.links[0].joint_name = base.name + "_joint";
  car.links[0].T_parent_link = T_base_root;
  car.links.insert(car.links.begin(), base);
  for (CarWheel& wheel : car.wheels) ++wheel.link;
  for (std::size_t& knuckle : car.knuckles) ++knuckle;
  if (car.pan) ++car.pan->link;
}

// The axles that are off symmetry by less than kLopsided_m, for one warning.
class Asymmetry {
 public:
  void Add(const std::string& what, double off_m) {
    if (off_m > kSymmetric_m) text_ += fmt::format("{}{} by {:.2f} mm", text_.empty() ? "" : ", ", what, 1e3 * off_m);
  }
  void Warn(const UrdfSource& source, CarDescription& car) const {
    if (!text_.empty())
      car.warnings.push_back(fmt::format("{}: left and right are not symmetric: {}; their means count (up to {:g} mm)",
                                         source.path.string(), text_, 1e3 * kLopsided_m));
  }

 private:
  std::string text_;
};

bool IsLopsided(double off_m) { return !(off_m < kLopsided_m - 1e-9); }  // files round

// Wheels as on a car: two axles, each symmetric about the base's x axis, all on the ground.
void DeriveWheels(const UrdfSource& source, Tree& tree, const Middles& middles_root, const Pose& T_base_root,
                  CarDescription& car, Asymmetry& asymmetry) {
  const Middles middles = Transformed(T_base_root, middles_root);
  car.wheelbase_m = 0.5 * (middles[0].x() + middles[1].x());
  car.track_m = 0.5 * (middles[0].y() - middles[1].y() + middles[2].y() - middles[3].y());
  for (const std::size_t left : {0u, 2u}) {
    const CarLink& link = tree.Link(car.wheels[left].link);
    const double off_m = OffSymmetry_m(middles[left], middles[left + 1]);
    asymmetry.Add(left == 0 ? "the front wheels" : "the rear wheels", off_m);
    if (IsLopsided(off_m))
      throw InputError(source.Where(link.name), fmt::format("'{}': the wheels are not two axles of one car", link.name),
                       fmt::format("it and '{}' less than {:g} mm off symmetry about the car's middle",
                                   tree.Link(car.wheels[left + 1].link).name, 1e3 * kLopsided_m),
                       fmt::format("{:.6g} mm: {} and {}", 1e3 * off_m, Text(middles[left]), Text(middles[left + 1])));
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

// Ackermann's law, the other way: the middle angle at which the wheel of that side stands at its own.
double MiddleAngle_rad(const CarDescription& car, double wheel_rad, double side) {
  const double tangent = std::tan(wheel_rad);
  return std::atan2(tangent, 1.0 + 0.5 * side * car.steering_track_m / car.wheelbase_m * tangent);
}

// The same joint, counted the other way.
void TurnRound(CarLink& link) {
  link.axis = -link.axis;
  std::swap(link.joint_min_rad, link.joint_max_rad);
  link.joint_min_rad = -link.joint_min_rad, link.joint_max_rad = -link.joint_max_rad;
}

void DeriveSteering(const UrdfSource& source, Tree& tree, const Pose& T_base_root, CarDescription& car,
                    Asymmetry& asymmetry) {
  std::array<Eigen::Vector3d, 2> pivots;
  for (std::size_t i = 0; i < 2; ++i) {
    CarLink& link = tree.Link(car.knuckles[i]);
    const Eigen::Vector3d axis = T_base_root.linear() * tree.AxisInRoot(car.knuckles[i]);
    if (std::abs(axis.z()) < kParallel)
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}': axis", link.joint_name),
                       "an upright one");
    if (axis.z() < 0.0) TurnRound(link);
    const Eigen::Vector3d joint = T_base_root * tree.T_root(car.knuckles[i]).translation();
    pivots[i] = joint + axis * (car.wheel_radius_m - joint.z()) / axis.z();
  }
  const CarLink& left = tree.Link(car.knuckles[0]);
  const double pivot_m = 0.5 * (pivots[0].x() + pivots[1].x());
  if (!(std::abs(pivot_m - car.wheelbase_m) <= kTrailMax * car.wheelbase_m))
    throw InputError(source.Where(left.joint_name), fmt::format("joint '{}': its axis", left.joint_name),
                     fmt::format("at x {:.6g} m as the wheel's middle", car.wheelbase_m),
                     fmt::format("{:.6g} m", pivot_m));
  car.steering_track_m = pivots[0].y() - pivots[1].y();
  const double off_m = OffSymmetry_m(pivots[0], pivots[1]);
  asymmetry.Add("the steering axes", off_m);
  if (!(car.steering_track_m > 0.0) || IsLopsided(off_m))
    throw InputError(source.Where(left.joint_name),
                     fmt::format("joints '{}' and '{}': the two steering axes", left.joint_name,
                                 tree.Link(car.knuckles[1]).joint_name),
                     fmt::format("one on each side, less than {:g} mm off symmetry", 1e3 * kLopsided_m),
                     fmt::format("{} and {}", Text(pivots[0]), Text(pivots[1])));
  car.steering_max_rad = HUGE_VAL;
  for (std::size_t i = 0; i < 2; ++i) {
    const CarLink& link = tree.Link(car.knuckles[i]);
    if (!(link.joint_min_rad < 0.0 && link.joint_max_rad > 0.0 &&
          std::max(-link.joint_min_rad, link.joint_max_rad) < 1.5))
      throw InputError(source.Where(link.joint_name), fmt::format("joint '{}': steering limits", link.joint_name),
                       "both sides of 0, below 1.5 rad",
                       fmt::format("{} and {} rad", link.joint_min_rad, link.joint_max_rad));
    for (const double limit_rad : {link.joint_min_rad, link.joint_max_rad})
      car.steering_max_rad = std::min(car.steering_max_rad, std::abs(MiddleAngle_rad(car, limit_rad, kSides[i])));
  }
}

// The axis of the joint that turns the cameras: upright, positive to the left. Its link hangs on the base.
void DerivePan(const UrdfSource& source, const CarMapping& mapping, Tree& tree, const Pose& T_base_root,
               CarDescription& car) {
  const bool named = !mapping.pan_joint.where.empty();
  if (!named && std::ranges::find(car.links, mapping.pan_joint.name, &CarLink::joint_name) == car.links.end()) return;
  const std::size_t index = tree.LinkBehind(mapping.pan_joint);
  CarLink& link = tree.Link(index);
  const std::string where = source.Where(link.joint_name), what = fmt::format("joint '{}'", link.joint_name);
  if (link.joint != CarLink::Joint::kRevolute) throw InputError(where, what + " turns the cameras", "type revolute");
  const Eigen::Vector3d axis = T_base_root.linear() * tree.AxisInRoot(index);
  if (std::abs(axis.z()) < kParallel) throw InputError(where, what + ": axis", "an upright one");
  if (axis.z() < 0.0) TurnRound(link);
  if (!(link.joint_min_rad <= 0.0 && link.joint_max_rad >= 0.0 && link.joint_speed_max_rad_s > 0.0))
    throw InputError(where, what + ": limits", "lower <= 0 <= upper, and a velocity above 0");
  for (const RoleName& camera : {mapping.depth_camera, mapping.color_camera})
    if (tree.Has(camera) && !tree.IsBelow(tree.LinkOf(camera), index))
      throw InputError(where, what + " turns the cameras", fmt::format("'{}' below it", camera.name));
  const Eigen::Vector3d pivot = T_base_root * tree.T_root(index).translation();
  car.pan = CarPan{.link = index,
                   .T_base_pan = AtAxle(pivot, axis.z() < 0.0 ? Eigen::Vector3d(-axis) : axis),
                   .slew_rad_s = link.joint_speed_max_rad_s};
}

// What moves as one piece, the body, a knuckle or a wheel, needs a mass somewhere.
void RefuseMassless(const UrdfSource& source, Tree& tree, const CarDescription& car) {
  std::set<std::size_t> heads{0, car.knuckles[0], car.knuckles[1]};
  for (const CarWheel& wheel : car.wheels) heads.insert(wheel.link);
  FaultList faults;
  for (const std::size_t head : heads) {
    double mass_kg = 0.0;
    std::size_t named = head;  // the first that is seen or touches
    for (std::size_t i = car.links.size(); i-- > head;) {
      if (tree.HeadOf(i, heads) != head) continue;
      mass_kg += car.links[i].mass_kg;
      if (!car.links[i].visual.empty() || !car.links[i].collision.empty()) named = i;
    }
    const std::string& name = car.links[named].name;
    if (!(mass_kg > 0.0))
      faults.Add(
          {source.Where(name),
           fmt::format("link '{}' moves: it needs a mass, and neither it nor a link that is fixed to it has one", name),
           "an <inertial> with <mass> and <inertia>"});
  }
  faults.ThrowIfAny();
}

// A camera's optical frame in the link that its role names: x right, y down, z ahead in x ahead, y left, z up.
Pose OpticalIn(const RoleName& camera) {
  Pose T_link_optical = Pose::Identity();
  if (!camera.role.ends_with("_optical_frame")) T_link_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_link_optical;
}

}  // namespace

Drivetrain ReadDrivetrain(const UrdfSource& source) {
  const TiXmlElement* element = source.document.RootElement()->FirstChildElement("drivetrain");
  if (element == nullptr)
    throw InputError(
        source.path.string(),
        fmt::format("the car needs an element <drivetrain .../> under <robot>, or a map 'drivetrain' in {}",
                    MappingFile(source.path).filename().string()));
  const std::string where = fmt::format("{}:{}", source.path.string(), element->Row());
  Drivetrain drivetrain;
  EachDrivetrainNumber(drivetrain, [&]<class T>(const char* name, T& value, Range range) {
    double number = 0.0;
    const int status = element->QueryDoubleAttribute(name, &number);
    const std::string what = fmt::format("<drivetrain> '{}'", name);
    if (status == TIXML_NO_ATTRIBUTE) throw InputError(where, fmt::format("<drivetrain> needs '{}'", name));
    if (status != TIXML_SUCCESS || !(number > 0.0) || !std::isfinite(number))
      throw InputError(where, what, "a positive number", element->Attribute(name));
    if (std::is_integral_v<T> && (number != std::floor(number) || number > range.max))
      throw InputError(where, what, fmt::format("a whole number up to {:.0f}", range.max), element->Attribute(name));
    value = static_cast<T>(number);
  });
  return drivetrain;
}

void DeriveGeometry(const UrdfSource& source, const CarMapping& mapping, CarDescription& car) {
  Tree tree(source, car.links);
  FindRoles(source, mapping, tree, car);
  const Middles middles = DeriveTyres(source, mapping, tree, car);
  const Pose T_base_root = BaseInRoot(source, middles, car.wheel_radius_m).inverse();
  Asymmetry asymmetry;
  DeriveWheels(source, tree, middles, T_base_root, car, asymmetry);
  DeriveSteering(source, tree, T_base_root, car, asymmetry);
  asymmetry.Warn(source, car);
  const auto frame = [&](const RoleName& role) { return T_base_root * tree.T_root(tree.LinkOf(role)); };
  // A mapping that says nothing of it leaves a sensor out.
  const auto left_out = [&](const RoleName& role) { return mapping.has_file && role.where.empty() && !tree.Has(role); };
  car.T_base_depth = frame(mapping.depth_camera) * OpticalIn(mapping.depth_camera);
  if (!left_out(mapping.color_camera)) car.T_base_color = frame(mapping.color_camera) * OpticalIn(mapping.color_camera);
  if (!left_out(mapping.compass)) car.T_base_compass = frame(mapping.compass);
  DerivePan(source, mapping, tree, T_base_root, car);
  RefuseMassless(source, tree, car);
  if (!T_base_root.matrix().isIdentity(0.0)) PutBaseAboveRoot(T_base_root, car);
}

}  // namespace merlin
