#include "robot/description/urdf_source.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <fstream>
#include <iterator>

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
  throw InputError(where, "not a robot: " + (error.text.empty() ? "urdfdom gives no reason" : error.text));
}

}  // namespace merlin
