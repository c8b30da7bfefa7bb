#include "robot/description/car_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"
#include "robot/description/axles.h"
#include "robot/description/drivetrain_numbers.h"
#include "robot/description/link_tree.h"
#include "robot/description/steering_axes.h"
#include "robot/description/tyres.h"

namespace merlin {
namespace {

// Finds the joint of each role. A joint may have one role only, and must be of the right type for it.
void FindRoles(const UrdfSource& source, const CarMapping& mapping, LinkTree& tree, CarDescription& car) {
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

// Every rigid piece (the body, a knuckle, a wheel) needs a mass in at least one of its links.
void RefuseMassless(const UrdfSource& source, LinkTree& tree, const CarDescription& car) {
  std::set<std::size_t> heads{0, car.knuckles[0], car.knuckles[1]};
  for (const CarWheel& wheel : car.wheels) heads.insert(wheel.link);
  FaultList faults;
  for (const std::size_t head : heads) {
    double mass_kg = 0.0;
    std::size_t named = head;  // the first one with a shape
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

// The optical frame of a camera (x right, y down, z ahead) in the link that its role names. That link either is the
// optical frame, or has x ahead, y left, z up.
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
  LinkTree tree(source, car.links);
  FindRoles(source, mapping, tree, car);
  const Middles middles = DeriveTyres(source, mapping, tree, car);
  const Pose T_base_root = BaseInRoot(source, middles, car.wheel_radius_m).inverse();
  Asymmetry asymmetry;
  DeriveWheels(source, tree, middles, T_base_root, car, asymmetry);
  DeriveSteering(source, tree, T_base_root, car, asymmetry);
  asymmetry.Warn(source, car);
  const auto frame = [&](const RoleName& role) { return T_base_root * tree.T_root(tree.LinkOf(role)); };
  // A mapping file that does not name a sensor means a car without it.
  const auto left_out = [&](const RoleName& role) { return mapping.has_file && role.where.empty() && !tree.Has(role); };
  car.T_base_depth = frame(mapping.depth_camera) * OpticalIn(mapping.depth_camera);
  if (!left_out(mapping.color_camera)) car.T_base_color = frame(mapping.color_camera) * OpticalIn(mapping.color_camera);
  if (!left_out(mapping.compass)) car.T_base_compass = frame(mapping.compass);
  DerivePan(source, mapping, tree, T_base_root, car);
  RefuseMassless(source, tree, car);
  if (!T_base_root.matrix().isIdentity(0.0)) PutBaseAboveRoot(T_base_root, car);
}

}  // namespace merlin
