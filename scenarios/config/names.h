// Where models and scenarios are, and what there is: names to files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace merlin {

// The folder that holds models/ and scenarios/: $MERLIN_HOME, default the source tree this was built from.
std::filesystem::path Home();

// Each takes a name or a path (with a '/' or the kind's ending) and throws InputError for one that is not there, naming the nearest.
std::filesystem::path ScenarioFile(const std::string& name_or_path);     // scenarios/<name>.yaml
std::filesystem::path RoomFile(const std::string& name_or_path);         // models/rooms/<name>.xml
std::filesystem::path CameraFile(const std::string& name_or_path);       // models/cameras/<name>.yaml
std::filesystem::path DepthCameraFile(const std::string& name_or_path);  // the same; refuses another kind
std::filesystem::path ColorCameraFile(const std::string& name_or_path);
std::filesystem::path ActorFile(const std::string& name_or_path);  // models/actors/<name>.xml
std::filesystem::path CarFile(const std::string& name_or_path);    // models/<name>/<name>.urdf
std::filesystem::path SweepFile(const std::string& name_or_path);  // scenarios/sweeps/<name>.yaml

// Sorted.
std::vector<std::string> ScenarioNames();
std::vector<std::string> RoomNames();
std::vector<std::string> CameraNames();
std::vector<std::string> SweepNames();

}  // namespace merlin
