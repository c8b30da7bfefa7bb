// A URDF file with what urdfdom's model no longer knows: the lines that errors name, and elements that are not URDF's.
#pragma once

#include <tinyxml.h>
#include <urdf_model/types.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <map>
#include <string>

namespace merlin {

struct UrdfSource {
  std::filesystem::path path;
  TiXmlDocument document;
  std::map<std::string, int> lines;  // of <link name="..."> and <joint name="...">

  // "file:line" of a link or joint, "file" if there is none of that name.
  std::string Where(const std::string& name) const;
  int Line(const std::string& name) const;  // 0: there is none
};

// Throws InputError: not readable, not well-formed XML (with its line), no <robot>.
UrdfSource ReadUrdf(const std::filesystem::path& path);

// The model as urdfdom understands it. Throws InputError with urdfdom's reason; what urdfdom drops without one is found
// by CheckUrdf (robot/description/urdf_check.h). Prints nothing.
urdf::ModelInterfaceSharedPtr ParseUrdf(const UrdfSource& source);

}  // namespace merlin
