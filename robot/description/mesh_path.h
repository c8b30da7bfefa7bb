// Finds the mesh file that a URDF names.
#pragma once

#include <filesystem>
#include <string>

namespace merlin {

// The absolute path of the file. The name may be
// - a path, or file:// and a path: absolute, or relative to the URDF's folder;
// - package://NAME/path, model://NAME/path or $(find NAME)/path (file:// before it or not): in the package's folder,
//   which is looked for, in this order, among the URDF's folder and all those above it (that have the package's name,
//   or a package.xml that gives it), among the folders in these, in the folders of ROS_PACKAGE_PATH and up to two
//   levels below, and in share/NAME of the folders of AMENT_PREFIX_PATH; at last in the URDF's own folder.
// Backslashes count as slashes. The first folder that has the file is used. Throws InputError(where, ...), which names
// what was looked for, and each place.
std::filesystem::path FindMesh(const std::filesystem::path& urdf, const std::string& name, const std::string& where,
                               const std::string& link);

}  // namespace merlin
