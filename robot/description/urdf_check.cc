#include "robot/description/urdf_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

#include "robot/base/nearest_name.h"
#include "robot/description/urdf_schema.h"

namespace merlin {
namespace {

constexpr std::size_t kLinesNamed = 12;  // of left-overs of xacro

std::string TextOf(const TiXmlElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text == nullptr ? "" : text;
}

std::string Hint(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = NearestName(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

template <class Visit>
void ForEachChild(const TiXmlElement& element, Visit visit) {
  for (const TiXmlElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) visit(*e);
}

bool IsXacro(const std::string& text) {
  return text.find("${") != std::string::npos || text.find("$(") != std::string::npos;
}

// A mesh's file name may say where to find a package.
bool IsXacro(const TiXmlElement& element, std::string_view attribute, std::string text) {
  if (element.ValueStr() == "mesh" && attribute == "filename")
    if (const std::size_t at = text.find("$(find "); at != std::string::npos) text.erase(at, 2);
  return IsXacro(text);
}

class Check {
 public:
  Check(const UrdfSource& source, UrdfFaults& faults) : source_(source), faults_(faults) {}

  void Elements(const TiXmlElement& element, const UrdfElement& urdf) {
    for (const UrdfAttribute& attribute : urdf.attributes) Attribute(element, attribute);
    if (std::string_view(urdf.name) == "geometry") return Shapes(element);
    std::map<std::string, int> count;
    ForEachChild(element, [&](const TiXmlElement& child) {
      const auto known = std::ranges::find(urdf.children, child.ValueStr(), &UrdfElement::name);
      if (known == urdf.children.end()) return RefuseMisplaced(child, urdf);
      if (++count[known->name] == 2 && known->occurs == Occurs::kOnce)
        Fault(child, fmt::format("a second <{}> in one <{}>", known->name, urdf.name), "one");
      if (urdf.name == std::string_view("robot")) {
        owner_ = TextOf(child, "name");
        owner_text_ = fmt::format("{} '{}': ", child.ValueStr(), owner_);
      }
      Elements(child, *known);
    });
    for (const UrdfElement& child : urdf.children)
      if (child.occurs == Occurs::kOnce && count[child.name] == 0)
        Fault(element, fmt::format("<{}> needs a <{}>", urdf.name, child.name));
  }

  // True: the whole file is xacro.
  bool Xacro(const TiXmlElement& robot) {
    std::vector<int> lines;
    std::string first;
    FindXacro(robot, lines, first);
    if (lines.empty()) return false;
    std::string also;
    for (std::size_t i = 1; i < lines.size() && i <= kLinesNamed; ++i)
      also += fmt::format("{}{}", also.empty() ? " (also at line " : ", ", lines[i]);
    if (!also.empty())
      also += lines.size() > kLinesNamed + 1 ? fmt::format(" and {} more)", lines.size() - 1 - kLinesNamed) : ")";
    faults_.list.Add(InputError(
        fmt::format("{}:{}", source_.path.string(), lines[0]), fmt::format("{} is xacro, not URDF{}", first, also),
        fmt::format("what xacro makes of the file: xacro {} > expanded.urdf", source_.path.filename().string())));
    bool whole = false;
    ForEachChild(robot, [&](const TiXmlElement& child) { whole = whole || child.ValueStr().starts_with("xacro:"); });
    return whole;
  }

  void Joints(const TiXmlElement& robot) {
    std::vector<std::string> links;
    ForEachChild(robot, [&](const TiXmlElement& e) {
      if (e.ValueStr() == "link") links.push_back(TextOf(e, "name"));
    });
    Names(robot, "link"), Names(robot, "joint");
    std::map<std::string, const TiXmlElement*> joint_above;  // by the link that hangs on it
    bool is_whole = true;
    for (const TiXmlElement* joint = robot.FirstChildElement("joint"); joint;
         joint = joint->NextSiblingElement("joint")) {
      Begin(*joint);
      Type(*joint);
      for (const char* end : {"parent", "child"}) {
        const std::string link = LinkOf(*joint, end);
        if (std::ranges::find(links, link) != links.end()) continue;
        is_whole = false;
        if (!link.empty() && !IsXacro(link))
          Fault(*joint, fmt::format("its {} link '{}' is not in the file{}", end, link, Hint(link, links)));
      }
      const std::string child = LinkOf(*joint, "child");
      if (!child.empty() && !joint_above.emplace(child, joint).second)
        Fault(*joint, fmt::format("link '{}' already hangs on another joint", child));
    }
    if (RefuseCycles(joint_above) || !is_whole) return;
    std::string root;
    for (const TiXmlElement* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
      const std::string name = TextOf(*link, "name");
      if (name.empty() || joint_above.contains(name)) continue;
      Begin(*link);
      if (!root.empty()) Fault(*link, fmt::format("a second root beside '{}'", root), "a joint that it hangs on");
      if (root.empty()) root = name;
    }
  }

 private:
  void Begin(const TiXmlElement& part) {
    owner_ = TextOf(part, "name");
    owner_text_ = fmt::format("{} '{}': ", part.ValueStr(), owner_);
  }

  void Fault(const TiXmlElement& at, const std::string& what, const std::string& expected = "",
             const std::string& got = "") {
    faults_.list.Add(
        InputError(fmt::format("{}:{}", source_.path.string(), at.Row()), owner_text_ + what, expected, got));
    faults_.parts.insert(owner_);
  }

  void Attribute(const TiXmlElement& element, const UrdfAttribute& attribute) {
    const char* text = element.Attribute(attribute.name);
    if (text == nullptr || (attribute.numbers == 0 && *text == '\0')) {
      if (attribute.required) Fault(element, fmt::format("<{}> needs '{}'", element.Value(), attribute.name));
    } else if (IsXacro(element, attribute.name, text)) {
      faults_.parts.insert(owner_);  // one fault names them all
    } else if (attribute.numbers > 0 && !AreNumbers(text, attribute)) {
      Fault(element, fmt::format("<{}> '{}'", element.Value(), attribute.name), Expected(attribute),
            fmt::format("'{}'", text));
    }
  }

  // A <geometry> has one shape, and URDF knows four.
  void Shapes(const TiXmlElement& geometry) {
    const std::string in = geometry.Parent()->ValueStr();
    const TiXmlElement* shape = geometry.FirstChildElement();
    if (shape == nullptr) return Fault(geometry, fmt::format("the <geometry> of a <{}> is empty", in), kShapeNames);
    for (const TiXmlElement* e = shape; e != nullptr; e = e->NextSiblingElement()) {
      const auto known = std::ranges::find(UrdfShapes(), e->ValueStr(), &UrdfElement::name);
      if (known == UrdfShapes().end()) {
        if (!e->ValueStr().starts_with("xacro:"))
          Fault(*e, fmt::format("<{}> in a <{}> is not a shape of URDF", e->Value(), in), kShapeNames);
      } else if (e != shape) {
        Fault(*e, fmt::format("a second shape in one <geometry>: <{}>", e->Value()),
              fmt::format("a <{}> for each", in));
      } else {
        Elements(*e, *known);
      }
    }
  }

  // An element that can hold shapes is never an extension. Where URDF does not expect it, it is a fault.
  void RefuseMisplaced(const TiXmlElement& child, const UrdfElement& parent) {
    static const std::set<std::string> kBearers{"link", "joint",    "visual", "collision", "geometry",
                                                "box",  "cylinder", "sphere", "mesh"};
    if (!kBearers.contains(child.ValueStr())) return;
    if (parent.name == std::string_view("robot")) owner_.clear(), owner_text_.clear();
    Fault(child, fmt::format("<{}> has no meaning in <{}>", child.Value(), parent.name));
  }

  void FindXacro(const TiXmlElement& element, std::vector<int>& lines, std::string& first) {
    const auto found = [&](const std::string& what) {
      if (lines.empty()) first = what;
      if (lines.empty() || lines.back() != element.Row()) lines.push_back(element.Row());
    };
    if (element.ValueStr().starts_with("xacro:")) return found(fmt::format("<{}>", element.Value()));
    for (const TiXmlAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (IsXacro(element, a->Name(), a->ValueStr())) found(fmt::format("{}=\"{}\"", a->Name(), a->Value()));
    }
    const bool is_robot = element.Parent() == &source_.document;
    ForEachChild(element, [&](const TiXmlElement& child) {
      const std::string& name = child.ValueStr();
      if (!is_robot || name == "link" || name == "joint" || name == "material" || name.starts_with("xacro:"))
        FindXacro(child, lines, first);
    });
  }

  void Names(const TiXmlElement& robot, const char* kind) {
    std::map<std::string, int> lines;
    for (const TiXmlElement* e = robot.FirstChildElement(kind); e != nullptr; e = e->NextSiblingElement(kind)) {
      Begin(*e);
      if (owner_ == "world" && e->ValueStr() == "link") Fault(*e, "the name is the simulation's own", "another");
      const auto [first, is_new] = lines.emplace(owner_, e->Row());
      if (!is_new && !owner_.empty())
        Fault(*e, fmt::format("the name is given twice, first in line {}", first->second));
    }
  }

  void Type(const TiXmlElement& joint) {
    const std::string type = TextOf(joint, "type");
    if (type.empty() || IsXacro(type)) return;  // reported already
    if (type != "fixed" && type != "revolute" && type != "continuous" && type != "prismatic")
      return Fault(joint, "type", "fixed, revolute, continuous or prismatic: the car is one piece",
                   fmt::format("'{}'", type));
    if ((type == "revolute" || type == "prismatic") && joint.FirstChildElement("limit") == nullptr)
      Fault(joint, fmt::format("a {} joint needs a <limit>", type));
  }

  static std::string LinkOf(const TiXmlElement& joint, const char* end) {
    const TiXmlElement* element = joint.FirstChildElement(end);
    return element == nullptr ? "" : TextOf(*element, "link");
  }

  bool RefuseCycles(const std::map<std::string, const TiXmlElement*>& joint_above) {
    for (const auto& [link, joint] : joint_above) {
      std::string above = LinkOf(*joint, "parent");
      for (std::size_t steps = 0; joint_above.contains(above) && above != link && steps <= joint_above.size(); ++steps)
        above = LinkOf(*joint_above.at(above), "parent");
      if (above != link) continue;
      Begin(*joint);
      Fault(*joint, fmt::format("link '{}' hangs below itself", link), "a tree of links");
      return true;
    }
    return false;
  }

  const UrdfSource& source_;
  UrdfFaults& faults_;
  std::string owner_;       // the link, joint or material being checked
  std::string owner_text_;  // ... as a sentence begins
};

}  // namespace

void CheckUrdf(const UrdfSource& source, UrdfFaults& faults) {
  const TiXmlElement& robot = *source.document.RootElement();
  Check check(source, faults);
  if (check.Xacro(robot)) return;
  check.Elements(robot, UrdfRobot());
  check.Joints(robot);
}

}  // namespace merlin
