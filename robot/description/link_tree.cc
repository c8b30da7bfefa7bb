#include "robot/description/link_tree.h"

#include <fmt/format.h>

#include <algorithm>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"

namespace merlin {

LinkTree::LinkTree(const UrdfSource& source, std::vector<CarLink>& links) : source_(source), links_(links) {
  for (const CarLink& link : links) {
    const auto parent = std::ranges::find(links, link.parent, &CarLink::name);
    parents_.push_back(link.parent.empty() ? 0 : static_cast<std::size_t>(parent - links.begin()));
    T_root_link_.push_back(link.parent.empty() ? Pose::Identity() : T_root_link_[parents_.back()] * link.T_parent_link);
  }
}

bool LinkTree::IsBelow(std::size_t index, std::size_t ancestor) const {
  while (index != ancestor && index != 0) index = parents_[index];
  return index == ancestor;
}

std::size_t LinkTree::HeadOf(std::size_t index, const std::set<std::size_t>& heads) const {
  while (!heads.contains(index)) index = parents_[index];
  return index;
}

bool LinkTree::Has(const RoleName& frame) const {
  return std::ranges::find(links_, frame.name, &CarLink::name) != links_.end();
}

std::size_t LinkTree::LinkOf(const RoleName& frame) const {
  return Find(frame, "link", [](const CarLink& link) { return link.name; });
}

std::size_t LinkTree::LinkBehind(const RoleName& joint) const {
  return Find(joint, "joint", [](const CarLink& link) { return link.joint_name; });
}

template <class NameOf>
std::size_t LinkTree::Find(const RoleName& role, const std::string& kind, NameOf name_of) const {
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

}  // namespace merlin
