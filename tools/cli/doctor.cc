#include "tools/cli/doctor.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "scenarios/config/names.h"
#include "tools/cli/gl_probe.h"
#include "tools/cli/licenses.h"
#include "tools/json_text.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Files that a run reads besides its scenario.
struct Models {
  fs::path home;
  bool car = false, materials = false;
  std::size_t scenarios = 0, rooms = 0, cameras = 0;

  bool Complete() const { return car && materials && scenarios > 0 && rooms > 0 && cameras > 0; }
};

// models/<name>/<name>.urdf, for any name.
bool HasCar(const fs::path& home) {
  std::error_code unreadable;
  for (const fs::directory_entry& entry : fs::directory_iterator(home / "models", unreadable))
    if (fs::exists(entry.path() / (entry.path().filename().string() + ".urdf"), unreadable)) return true;
  return false;
}

Models FindModels() {
  const fs::path home = Home();
  std::error_code unreadable;
  return {.home = home,
          .car = HasCar(home),
          .materials = fs::exists(home / "models/materials.yaml", unreadable),
          .scenarios = ScenarioNames().size(),
          .rooms = RoomNames().size(),
          .cameras = CameraNames().size()};
}

struct Report {
  std::vector<GlProbe> gl;
  Models models;
  unsigned cpu_cores = 0;

  // The exit code that a run would have here. Without the twin no pictures are drawn.
  int ExitCode() const {
    const bool draws = std::any_of(gl.begin(), gl.end(), [](const GlProbe& probe) { return probe.works; });
    return !models.Complete() ? 2 : draws || !MERLIN_TWIN ? 0 : 3;
  }
};

void PrintText(const Report& report) {
  fmt::print("merlin    {} ({}), {} CPU cores\n", MERLIN_VERSION, MERLIN_BUILD, report.cpu_cores);
  fmt::print("twin      {}\n", MERLIN_TWIN ? "built in" : "not built in (MERLIN_TWIN=OFF): no simulation, no pictures");
  for (const GlProbe& probe : report.gl)
    fmt::print("gl        {:<7}{}: {}\n", probe.backend, probe.works ? "works" : "does not open", probe.detail);
  const Models& models = report.models;
  fmt::print("models    {}: {}, {}, {} rooms, {} cameras, {} scenarios\n", models.home.string(),
             models.car ? "the car" : "no car (models/<name>/<name>.urdf)",
             models.materials ? "materials" : "no models/materials.yaml", models.rooms, models.cameras,
             models.scenarios);
  fmt::print("with     ");
  for (const LinkedWork& work : LinkedWorks())
    if (!work.version.empty()) fmt::print(" {} {};", work.name, work.version);
  fmt::print(" terms: merlin doctor --licenses\n");
  fmt::print("{}\n", report.ExitCode() == 0 ? "Everything that a run needs works here."
                                            : "Something that a run may need does not work here: see above.");
}

void PrintJson(const Report& report) {
  Json versions{{"merlin", MERLIN_VERSION}};
  for (const LinkedWork& work : LinkedWorks())
    if (!work.version.empty()) versions[work.name] = work.version;
  Json gl = Json::array();
  for (const GlProbe& probe : report.gl)
    gl.push_back({{"backend", probe.backend}, {"works", probe.works}, {"detail", probe.detail}});
  const Models& models = report.models;
  const Json whole{{"well", report.ExitCode() == 0},
                   {"twin", MERLIN_TWIN != 0},
                   {"build", MERLIN_BUILD},
                   {"cpu_cores", report.cpu_cores},
                   {"gl", gl},
                   {"models",
                    {{"folder", (models.home / "models").string()},
                     {"car", models.car},
                     {"materials", models.materials},
                     {"rooms", models.rooms},
                     {"cameras", models.cameras},
                     {"scenarios", models.scenarios}}},
                   {"versions", versions}};
  fmt::print("{}", JsonText(whole));
}

void PrintLicenses(bool json) {
  Json list = Json::array();
  if (!json) fmt::print("merlin {} is under Apache-2.0 (file LICENSE). It is linked with:\n\n", MERLIN_VERSION);
  for (const LinkedWork& work : LinkedWorks()) {
    if (json)
      list.push_back({{"name", work.name}, {"version", work.version}, {"license", work.license}, {"how", work.how}});
    else
      fmt::print("{:<35}{:<9}{:<42}{}\n", work.name, work.version, work.license, work.how);
  }
  if (json)
    fmt::print("{}", JsonText(list));
  else
    fmt::print(
        "\nFull texts: /usr/share/doc/*/copyright of the Debian packages, which also name what these link in turn.\n");
}

}  // namespace

int Doctor(bool licenses, bool json) {
  if (licenses) {
    PrintLicenses(json);
    return 0;
  }
  const Report report{.gl = ProbeGl(), .models = FindModels(), .cpu_cores = std::thread::hardware_concurrency()};
  json ? PrintJson(report) : PrintText(report);
  if (!report.models.Complete())
    fmt::print(stderr, "merlin: {}: models or scenarios are missing there; is MERLIN_HOME right?\n",
               report.models.home.string());
  return report.ExitCode();
}

}  // namespace merlin::cli
