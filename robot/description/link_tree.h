// The links of a URDF as a tree, and the links that play the roles of the mapping.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "robot/description/car_mapping.h"
#include "robot/description/urdf_source.h"
#include "robot/types/car.h"

namespace merlin {

// The links by name, with their poses in the root's frame at joint angles 0. Source and links outlive it.
class LinkTree {
 public:
  LinkTree(const UrdfSource& source, std::vector<CarLink>& links);

  CarLink& Link(std::size_t index) { return links_[index]; }
  const Pose& T_root(std::size_t index) const { return T_root_link_[index]; }
  Eigen::Vector3d AxisInRoot(std::size_t index) const { return T_root_link_[index].linear() * links_[index].axis; }
  bool IsBelow(std::size_t index, std::size_t ancestor) const;
  // The nearest of these links above a link, or the link itself if it is one of them.
  std::size_t HeadOf(std::size_t index, const std::set<std::size_t>& heads) const;

  bool Has(const RoleName& frame) const;
  // The link of that name, and the link behind the joint of that name. Throw InputError, with the nearest name, where
  // the URDF has none.
  std::size_t LinkOf(const RoleName& frame) const;
  std::size_t LinkBehind(const RoleName& joint) const;

 private:
  template <class NameOf>
  std::size_t Find(const RoleName& role, const std::string& kind, NameOf name_of) const;

  const UrdfSource& source_;
  std::vector<CarLink>& links_;
  std::vector<std::size_t> parents_;
  std::vector<Pose> T_root_link_;
};

}  // namespace merlin
