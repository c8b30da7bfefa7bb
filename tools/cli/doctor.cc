#include "tools/cli/doctor.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tools/cli/gl_probe.h"
#include "tools/cli/licenses.h"

namespace merlin::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Models {
  fs::path folder;
  bool car = false;
  int rooms = 0;
  int cameras = 0;

  bool Complete() const { return car && rooms > 0 && cameras > 0; }
};

int CountFiles(const fs::path& folder, const char* extension) {
  std::error_code missing;
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing))
    count += entry.path().extension() == extension ? 1 : 0;
  return count;
}

Models FindModels() {
  const fs::path folder = fs::path(MERLIN_SOURCE_DIR) / "models";
  return {.folder = folder,
          .car = fs::exists(folder / "merlin" / "merlin.urdf"),
          .rooms = CountFiles(folder / "rooms", ".xml"),
          .cameras = CountFiles(folder / "cameras", ".yaml")};
}

struct Report {
  std::vector<GlProbe> gl;
  Models models;
  unsigned cpu_cores = 0;

  // Without the twin no picture is drawn, and no room is needed.
  bool Well() const {
    const bool draws = std::any_of(gl.begin(), gl.end(), [](const GlProbe& probe) { return probe.works; });
    return models.Complete() && (draws || !MERLIN_TWIN);
  }
};

void PrintText(const Report& report) {
  fmt::print("merlin    {} ({}), {} CPU cores\n", MERLIN_VERSION, MERLIN_BUILD, report.cpu_cores);
  fmt::print("twin      {}\n", MERLIN_TWIN ? "built in" : "not built in (MERLIN_TWIN=OFF): no simulation, no pictures");
  for (const GlProbe& probe : report.gl)
    fmt::print("gl        {:<7}{}: {}\n", probe.backend, probe.works ? "works" : "does not open", probe.detail);
  fmt::print("models    {}: {}, {} rooms, {} cameras\n", report.models.folder.string(),
             report.models.car ? "the car" : "no car (merlin/merlin.urdf)", report.models.rooms, report.models.cameras);
  fmt::print("with     ");
  for (const LinkedWork& work : LinkedWorks())
    if (!work.version.empty()) fmt::print(" {} {};", work.name, work.version);
  fmt::print(" terms: merlin doctor --licenses\n");
  fmt::print("{}\n", report.Well() ? "All that a run needs works here."
                                   : "Something a run may need does not work here: see above.");
}

void PrintJson(const Report& report) {
  Json versions{{"merlin", MERLIN_VERSION}};
  for (const LinkedWork& work : LinkedWorks())
    if (!work.version.empty()) versions[work.name] = work.version;
  Json gl = Json::array();
  for (const GlProbe& probe : report.gl)
    gl.push_back({{"backend", probe.backend}, {"works", probe.works}, {"detail", probe.detail}});
  const Models& models = report.models;
  const Json whole{
      {"well", report.Well()},
      {"twin", MERLIN_TWIN != 0},
      {"build", MERLIN_BUILD},
      {"cpu_cores", report.cpu_cores},
      {"gl", gl},
      {"models",
       {{"folder", models.folder.string()}, {"car", models.car}, {"rooms", models.rooms}, {"cameras", models.cameras}}},
      {"versions", versions}};
  fmt::print("{}\n", whole.dump(2));
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
    fmt::print("{}\n", list.dump(2));
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
  return report.Well() ? 0 : 3;
}

}  // namespace merlin::cli
