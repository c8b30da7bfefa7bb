// A URDF file with what urdfdom's model does not keep: line numbers for errors, and elements that URDF does not define.
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

// The model as urdfdom understands it. Throws InputError with urdfdom's reason. CheckUrdf
// (robot/description/urdf_check.h) finds what urdfdom drops without giving a reason. Prints nothing.
urdf::ModelInterfaceSharedPtr ParseUrdf(const UrdfSource& source);

}  // namespace merlin
