#include "robot/description/urdf_source.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "robot/description/urdf_schema.h"

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

// Rewrites numbers as urdfdom reads them: one blank between two, none before or after. (It reads " 4" as no mass, and
// then drops the rest of the link.)
void TidyNumbers(TiXmlElement& element, const UrdfElement& urdf) {
  for (const UrdfAttribute& attribute : urdf.attributes) {
    const char* text = attribute.numbers > 0 ? element.Attribute(attribute.name) : nullptr;
    if (text == nullptr) continue;
    std::istringstream words(text);
    std::string tidy;
    for (std::string word; words >> word;) tidy += (tidy.empty() ? "" : " ") + word;
    element.SetAttribute(attribute.name, tidy.c_str());
  }
  const auto& children = std::string_view(urdf.name) == "geometry" ? UrdfShapes() : urdf.children;
  for (TiXmlElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    for (const UrdfElement& child : children)
      if (e->ValueStr() == child.name) TidyNumbers(*e, child);
}

}  // namespace

std::string UrdfSource::Where(const std::string& name) const {
  const int line = Line(name);
  return line == 0 ? path.string() : fmt::format("{}:{}", path.string(), line);
}

int UrdfSource::Line(const std::string& name) const {
  const auto line = lines.find(name);
  return line == lines.end() ? 0 : line->second;
}

UrdfSource ReadUrdf(const std::filesystem::path& path) {
  UrdfSource source;
  source.path = path;
  const std::string text = ReadFile(path, "a URDF file");
  source.document.Parse(text.c_str());
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
  TiXmlDocument tidy = source.document;
  TidyNumbers(*tidy.RootElement(), UrdfRobot());
  TiXmlPrinter printer;
  tidy.Accept(&printer);
  FirstError error;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(printer.Str());
  } catch (const std::exception& e) {
    error.text = e.what();
  }
  if (model) return model;
  std::string where = source.path.string();  // urdfdom quotes the link or joint that it fails on
  for (const auto& [name, line] : source.lines)
    if (error.text.find("'" + name + "'") != std::string::npos ||
        error.text.find("[" + name + "]") != std::string::npos)
      where = source.Where(name);
  std::ranges::replace(error.text, '\n', ' ');
  throw InputError(where, "not a robot: " + (error.text.empty() ? "urdfdom gives no reason" : error.text));
}

}  // namespace merlin
