#include "robot/description/urdf_source.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "robot/types/error.h"

namespace merlin {
namespace {

// urdfdom reports through console_bridge, which prints; this keeps the first error instead.
class FirstError : public console_bridge::OutputHandler {
 public:
  FirstError() { console_bridge::useOutputHandler(this); }
  ~FirstError() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& message, console_bridge::LogLevel level, const char*, int) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text.empty()) text = message;
  }
  std::string text;
};

// How many numbers an attribute holds; 0: none of a number.
std::size_t NumbersIn(const std::string& attribute) {
  static const std::set<std::string> kOne{"radius", "length", "value", "ixx",   "ixy",    "ixz",     "iyy",
                                          "iyz",    "izz",    "lower", "upper", "effort", "velocity"};
  static const std::set<std::string> kThree{"xyz", "rpy", "size", "scale"};
  return kOne.contains(attribute) ? 1 : kThree.contains(attribute) ? 3 : attribute == "rgba" ? 4 : 0;
}

bool AreNumbers(const std::string& text, std::size_t expected) {
  std::istringstream words(text);
  std::size_t count = 0;
  for (std::string word; words >> word; ++count) {
    const char* begin = word.c_str() + (word[0] == '+' ? 1 : 0);
    double number = 0.0;
    const auto [rest, error] = std::from_chars(begin, word.c_str() + word.size(), number);
    if (error != std::errc() || *rest != '\0' || !std::isfinite(number)) return false;
  }
  return count == expected;
}

// urdfdom takes some bad numbers for none, and drops the shape or colour they belong to.
void RefuseBadNumbers(const UrdfSource& source, const TiXmlElement& element) {
  for (const TiXmlAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next())
    if (const std::size_t count = NumbersIn(a->Name()); count > 0 && !AreNumbers(a->Value(), count))
      throw InputError(fmt::format("{}:{}", source.path.string(), element.Row()),
                       fmt::format("<{}> '{}'", element.Value(), a->Name()),
                       count == 1 ? "a finite number" : fmt::format("{} finite numbers", count),
                       fmt::format("'{}'", a->Value()));
  for (const TiXmlElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    RefuseBadNumbers(source, *e);
}

std::string LinkOf(const TiXmlElement& joint, const char* end) {
  const TiXmlElement* element = joint.FirstChildElement(end);
  const char* name = element == nullptr ? nullptr : element->Attribute("link");
  return name == nullptr ? "" : name;
}

void RefuseCycles(const UrdfSource& source) {
  std::map<std::string, const TiXmlElement*> joint_above;  // by the link that hangs on it
  const TiXmlElement* robot = source.document.RootElement();
  const auto where = [&](const TiXmlElement& e) { return fmt::format("{}:{}", source.path.string(), e.Row()); };
  for (const TiXmlElement* joint = robot->FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const std::string child = LinkOf(*joint, "child");
    if (!child.empty() && !joint_above.emplace(child, joint).second)
      throw InputError(where(*joint), fmt::format("link '{}' already hangs on another joint", child));
  }
  for (const auto& [link, joint] : joint_above) {
    std::string above = LinkOf(*joint, "parent");
    for (std::size_t steps = 0; joint_above.contains(above) && above != link && steps <= joint_above.size(); ++steps)
      above = LinkOf(*joint_above.at(above), "parent");
    if (above == link)
      throw InputError(where(*joint), fmt::format("link '{}' hangs below itself", link), "a tree of links");
  }
}

}  // namespace

std::string UrdfSource::Where(const std::string& name) const {
  const auto line = lines.find(name);
  return line == lines.end() ? path.string() : fmt::format("{}:{}", path.string(), line->second);
}

UrdfSource ReadUrdf(const std::filesystem::path& path) {
  UrdfSource source;
  source.path = path;
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) throw InputError(path.string(), "cannot be read", "a URDF file");
  source.text.assign(std::istreambuf_iterator<char>(file), {});
  source.document.Parse(source.text.c_str());
  const TiXmlElement* robot = source.document.RootElement();
  if (source.document.Error())
    throw InputError(fmt::format("{}:{}", path.string(), std::max(1, source.document.ErrorRow())),
                     fmt::format("not well-formed XML ({})", source.document.ErrorDesc()));
  if (robot == nullptr || robot->ValueStr() != "robot") throw InputError(path.string(), "not a URDF", "<robot>");
  for (const TiXmlElement* e = robot->FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    if (e->Attribute("name") != nullptr && (e->ValueStr() == "link" || e->ValueStr() == "joint"))
      source.lines.emplace(e->Attribute("name"), e->Row());
  return source;
}

urdf::ModelInterfaceSharedPtr ParseUrdf(const UrdfSource& source) {
  for (const TiXmlElement* e = source.document.RootElement()->FirstChildElement(); e; e = e->NextSiblingElement())
    if (e->ValueStr() == "link" || e->ValueStr() == "joint" || e->ValueStr() == "material")
      RefuseBadNumbers(source, *e);
  RefuseCycles(source);
  FirstError error;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(source.text);
  } catch (const std::exception& e) {
    error.text = e.what();
  }
  if (model) return model;
  std::string where = source.path.string();  // urdfdom quotes the link or joint it stumbles over
  for (const auto& [name, line] : source.lines)
    if (error.text.find("'" + name + "'") != std::string::npos ||
        error.text.find("[" + name + "]") != std::string::npos)
      where = source.Where(name);
  std::ranges::replace(error.text, '\n', ' ');
  throw InputError(where, "not a robot: " + (error.text.empty() ? "urdfdom gives no reason" : error.text));
}

}  // namespace merlin
