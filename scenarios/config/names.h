// Finds the files of models and scenarios by name, and lists the names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace merlin {

// The folder that holds models/ and scenarios/: $MERLIN_HOME, or by default the source tree of this build.
std::filesystem::path Home();

// Each takes a name or a path (with a '/' or the file extension). Throws InputError if there is no such file, and
// suggests the nearest name.
std::filesystem::path ScenarioFile(const std::string& name_or_path);     // scenarios/<name>.yaml
std::filesystem::path RoomFile(const std::string& name_or_path);         // models/rooms/<name>.xml
std::filesystem::path CameraFile(const std::string& name_or_path);       // models/cameras/<name>.yaml
std::filesystem::path DepthCameraFile(const std::string& name_or_path);  // the same, depth cameras only
std::filesystem::path ColorCameraFile(const std::string& name_or_path);
std::filesystem::path ActorFile(const std::string& name_or_path);  // models/actors/<name>.xml
std::filesystem::path CarFile(const std::string& name_or_path);    // models/<name>/<name>.urdf
std::filesystem::path SweepFile(const std::string& name_or_path);  // scenarios/sweeps/<name>.yaml

// All names, sorted.
std::vector<std::string> ScenarioNames();
std::vector<std::string> RoomNames();
std::vector<std::string> CameraNames();
std::vector<std::string> SweepNames();

}  // namespace merlin
