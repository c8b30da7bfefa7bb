#include "scenarios/config/names.h"

#include <algorithm>
#include <cstdlib>

#include "robot/base/error.h"
#include "robot/base/nearest_name.h"
#include "robot/description/description.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> StemsIn(const fs::path& folder, const std::string& ending) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ending) names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

fs::path Resolve(const std::string& what, const std::string& name, const fs::path& named, const std::string& ending,
                 const std::vector<std::string>& known) {
  const bool is_path = name.find('/') != std::string::npos || name.ends_with(ending);
  const fs::path file = is_path ? fs::path(name) : named;
  std::error_code unreadable;
  if (fs::is_regular_file(file, unreadable)) return file;
  if (is_path) throw InputError(name, "no such " + what + " file");
  if (known.empty()) throw InputError(named.parent_path().string(), "no " + what + " there; is MERLIN_HOME right?");
  throw InputError("unknown " + what + " '" + name + "'; did you mean '" + NearestName(name, known) + "'?");
}

fs::path CameraPath(const std::string& name) { return Home() / "models/cameras" / (name + ".yaml"); }

std::vector<std::string> CameraNamesOf(CameraKind kind) {
  std::vector<std::string> names = CameraNames();
  std::erase_if(names, [=](const std::string& name) { return KindOfCamera(CameraPath(name)) != kind; });
  return names;
}

const char* Words(CameraKind kind) {
  return kind == CameraKind::kDepth   ? "a time-of-flight camera"
         : kind == CameraKind::kColor ? "a colour camera"
                                      : "no camera";
}

// A file of unknown kind passes: the reader of the data sheet reports what is wrong with it.
fs::path CameraOfKind(CameraKind kind, const std::string& name) {
  const std::vector<std::string> known = CameraNamesOf(kind);
  const fs::path file =
      Resolve(kind == CameraKind::kDepth ? "depth camera" : "colour camera", name, CameraPath(name), ".yaml", known);
  const CameraKind found = KindOfCamera(file);
  if (found == kind || found == CameraKind::kUnknown) return file;
  throw InputError(name, std::string("this is ") + Words(found),
                   Words(kind) + (known.empty() ? "" : ", such as " + NearestName(name, known)));
}

}  // namespace

fs::path Home() {
  const char* home = std::getenv("MERLIN_HOME");
  return home != nullptr && *home != 0 ? fs::path(home) : fs::path(MERLIN_SOURCE_DIR);
}

fs::path ScenarioFile(const std::string& name) {
  return Resolve("scenario", name, Home() / "scenarios" / (name + ".yaml"), ".yaml", ScenarioNames());
}
fs::path RoomFile(const std::string& name) {
  return Resolve("room", name, Home() / "models/rooms" / (name + ".xml"), ".xml", RoomNames());
}
fs::path CameraFile(const std::string& name) {
  return Resolve("camera", name, CameraPath(name), ".yaml", CameraNames());
}
fs::path DepthCameraFile(const std::string& name) { return CameraOfKind(CameraKind::kDepth, name); }
fs::path ColorCameraFile(const std::string& name) { return CameraOfKind(CameraKind::kColor, name); }
fs::path ActorFile(const std::string& name) {
  const fs::path folder = Home() / "models/actors";
  return Resolve("actor", name, folder / (name + ".xml"), ".xml", StemsIn(folder, ".xml"));
}
fs::path CarFile(const std::string& name) {
  return Resolve("car", name, Home() / "models" / name / (name + ".urdf"), ".urdf", {"merlin"});
}

fs::path SweepFile(const std::string& name) {
  return Resolve("sweep", name, Home() / "scenarios/sweeps" / (name + ".yaml"), ".yaml", SweepNames());
}

std::vector<std::string> ScenarioNames() { return StemsIn(Home() / "scenarios", ".yaml"); }
std::vector<std::string> RoomNames() { return StemsIn(Home() / "models/rooms", ".xml"); }
std::vector<std::string> CameraNames() { return StemsIn(Home() / "models/cameras", ".yaml"); }
std::vector<std::string> SweepNames() { return StemsIn(Home() / "scenarios/sweeps", ".yaml"); }

}  // namespace merlin
