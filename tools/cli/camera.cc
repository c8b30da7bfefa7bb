// `merlin camera`: frames of one simulated time-of-flight camera with their truth, for studying it.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include "robot/base/error.h"
#include "scenarios/config/names.h"
#include "tools/cli/commands.h"
#if MERLIN_TWIN
#include "robot/description/description.h"
#include "scenarios/judge/output_folder.h"
#include "tools/camera/files.h"
#include "tools/camera/picture.h"
#include "tools/camera/report.h"
#include "tools/camera/study.h"
#include "tools/json_text.h"
#endif

namespace merlin::cli {
namespace {

struct CameraArguments {
  std::string model, room, pose, curtain, out, study;
  std::optional<std::string> frequency_mhz, effects;
  std::optional<double> wall_m, albedo, tilt_deg, integration_us, sun_w_m2_nm;
  int frames = 20, threads = 2;
  std::uint64_t seed = 1;
  bool nearest = false, json = false;
};

#if MERLIN_TWIN

// Reads a list such as "1,2.5". Throws InputError if a part is not a finite number, or if there are too few or too many.
std::vector<double> Numbers(const std::string& option, const std::string& text, char between, std::size_t least,
                            std::size_t most, const std::string& expected) {
  std::vector<double> numbers;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(between, from), text.size());
    const std::string part = text.substr(from, to - from);
    std::size_t used = 0;
    try {
      numbers.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
    }
    if (part.empty() || used != part.size() || !std::isfinite(numbers.back()))
      throw InputError(option, "no such value", expected, "'" + text + "'");
    from = to + 1;
  }
  if (numbers.size() < least || numbers.size() > most)
    throw InputError(option, "no such value", expected, "'" + text + "'");
  return numbers;
}

Pose ReadPose(const std::string& text) {
  const std::vector<double> n =
      Numbers("--pose", text, ',', 6, 6, "x,y,z,roll,pitch,yaw in metres and radians, all finite");
  Pose T_world_body = Pose::Identity();
  T_world_body.translation() << n[0], n[1], n[2];
  T_world_body.linear() =
      (Eigen::AngleAxisd(n[5], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(n[4], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(n[3], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return T_world_body;
}

// Settings that are not given are 1000 us and 20 MHz, or the nearest valid ones of the camera.
DepthSettings SettingsOf(const CameraArguments& arguments, const DepthCameraSheet& sheet) {
  DepthSettings usual = NearestSettings(sheet, {}), asked = usual;
  if (arguments.integration_us) asked.integration_s = *arguments.integration_us * 1e-6;
  if (arguments.frequency_mhz) {
    const auto mhz =
        Numbers("--frequency-mhz", *arguments.frequency_mhz, '+', 1, 2, "one frequency, or two as in 20+30");
    asked.frequency_hz = mhz[0] * 1e6;
    if (mhz.size() == 2) asked.second_frequency_hz = mhz[1] * 1e6;
  }
  if (!arguments.nearest) {
    CheckSettings(sheet, asked);
    return asked;
  }
  const DepthSettings nearest = NearestSettings(sheet, asked);
  const auto say = [](const char* what, double from, double to, const char* unit) {
    if (from != to)
      fmt::print(stderr, "merlin: {}: {:g} {} instead of {:g} {}, the nearest valid value\n", what, to, unit, from,
                 unit);
  };
  say("integration time", asked.integration_s * 1e6, nearest.integration_s * 1e6, "us");
  say("frequency", asked.frequency_hz * 1e-6, nearest.frequency_hz * 1e-6, "MHz");
  say("second frequency", asked.second_frequency_hz * 1e-6, nearest.second_frequency_hz * 1e-6, "MHz");
  return nearest;
}

// Refuses options that do not belong to the chosen scene.
void RefuseMixtures(const CameraArguments& a) {
  const auto refuse = [](bool given, const char* option, const char* belongs_to) {
    if (given) throw InputError(option, std::string("belongs to ") + belongs_to);
  };
  const bool wall = a.wall_m.has_value(), room = !a.room.empty(), study = !a.study.empty();
  if (study) {
    refuse(wall || room, "--wall or --room", "a single measurement; a study brings its own scenes");
    refuse(a.sun_w_m2_nm.has_value(), "--sun", "a single measurement; a study brings its own scenes");
    refuse(a.effects.has_value(), "--effects", "a single measurement; a study brings its own effects");
  } else if (wall == room) {
    throw InputError("camera", "it needs one scene", "either --wall or --room", wall ? "both" : "neither");
  }
  refuse(!wall && a.albedo, "--albedo", "--wall");
  refuse(!wall && a.tilt_deg, "--tilt-deg", "--wall");
  refuse(!room && !a.pose.empty(), "--pose", "--room");
  refuse(!room && !a.curtain.empty(), "--curtain", "--room");
  if (room && a.pose.empty()) throw InputError("--room", "the camera has no pose in it", "--pose x,y,z,roll,pitch,yaw");
}

Stage StageOf(const CameraArguments& a) {
  if (a.wall_m)
    return WallStage({.distance_m = *a.wall_m,
                      .albedo = a.albedo.value_or(0.5),
                      .tilt_rad = a.tilt_deg.value_or(0.0) * std::numbers::pi / 180.0,
                      .ambient_w_m2_nm = a.sun_w_m2_nm.value_or(0.0)});
  return RoomStage({.room = RoomFile(a.room),
                    .materials = Home() / "models/materials.yaml",
                    .curtain_closed = a.curtain == "closed",
                    .T_world_body = ReadPose(a.pose),
                    .sun_w_m2_nm = a.sun_w_m2_nm});
}

int Shoot(const CameraArguments& arguments, const Shooting& shooting, const std::string& effects) {
  const Stage stage = StageOf(arguments);
  OutputFolder folder(arguments.out.empty() ? "runs/camera-" + shooting.sheet.name : arguments.out);
  const Measurement m = Measure(shooting, stage.View(), interrupted);
  if (interrupted) return kInterrupted;
  const std::string before = arguments.wall_m ? fmt::format("a wall at {:g} m", *arguments.wall_m) : arguments.room;
  const std::string title = shooting.sheet.name + " before " + before, settings = SettingsLine(shooting, effects);
  for (const auto& [name, bytes] : FrameFiles(m, shooting.sheet.camera)) folder.Write(name, bytes);
  folder.Write("picture.png", ToPng(m, title, settings));
  const std::string json = ToJson(m, shooting, effects);
  folder.Finish(json);
  if (arguments.json)
    fmt::print("{}", json);
  else
    fmt::print("{}: {}\n{}files: {} (look at picture.png)\n", title, settings, Summary(m), folder.path().string());
  return kPass;
}

int DrawStudy(const CameraArguments& arguments, const Shooting& shooting) {
  const std::string& name = arguments.study;
  CheckStudyName(name);
  OutputFolder folder(arguments.out.empty() ? "runs/camera-" + shooting.sheet.name + "-" + name : arguments.out);
  const Figure figure =
      Study(name, {shooting.sheet, shooting.errors, shooting.settings, shooting.seed, shooting.threads});
  folder.Write("study_" + name + ".png", ToPng(figure));
  folder.Write("study_" + name + ".csv", ToCsv(figure));
  const std::string json = JsonText({{"model", shooting.sheet.name},
                                     {"study", name},
                                     {"figure", "study_" + name + ".png"},
                                     {"numbers", "study_" + name + ".csv"}});
  folder.Finish(json);
  if (arguments.json)
    fmt::print("{}", json);
  else
    fmt::print("{}\n{}\nfiles: {} (look at study_{}.png)\n", figure.title, figure.subtitle, folder.path().string(),
               name);
  return kPass;
}

int Camera(const CameraArguments& arguments) {
  RefuseMixtures(arguments);
  if (!arguments.study.empty()) CheckStudyName(arguments.study);
  const std::filesystem::path file = DepthCameraFile(arguments.model);
  Shooting shooting{
      .sheet = ReadDepthCameraSheet(file), .errors = ReadDepthCameraErrors(file), .settings = {}, .effects = {}};
  const std::string effects = arguments.effects.value_or("all");
  shooting.effects = sim::ParseTofEffects(effects);
  shooting.settings = SettingsOf(arguments, shooting.sheet);
  shooting.seed = arguments.seed;
  shooting.frames = arguments.frames;
  shooting.threads = arguments.threads;
  return arguments.study.empty() ? Shoot(arguments, shooting, effects) : DrawStudy(arguments, shooting);
}

#else

int Camera(const CameraArguments& arguments) {
  (void)DepthCameraFile(arguments.model);
  throw MachineError("this build has no twin (MERLIN_TWIN=OFF)");
}

#endif

}  // namespace

void AddCamera(CLI::App& app, int& exit_code) {
  const auto a = std::make_shared<CameraArguments>();
  CLI::App* camera = app.add_subcommand("camera", "frames of one simulated time-of-flight camera, with their truth");
  camera->add_option("model", a->model, "a name in models/cameras/, or a path")->required();
  camera->add_option("--wall", a->wall_m, "look at a wall this many metres ahead");
  camera->add_option("--albedo", a->albedo, "of the wall, in the near infrared; default 0.5");
  camera->add_option("--tilt-deg", a->tilt_deg, "of the wall, about the vertical");
  camera->add_option("--room", a->room, "look into a room: a name in models/rooms/, or a path");
  camera
      ->add_option("--pose", a->pose,
                   "x,y,z,roll,pitch,yaw of the camera in the room [m, rad]: x forward, y left, z up")
      ->allow_extra_args(false);
  camera->add_option("--curtain", a->curtain, "open (default) or closed")->check(CLI::IsMember({"open", "closed"}));
  camera->add_option("--frames", a->frames, "default 20")->check(CLI::Range(1, 1000000));
  camera->add_option("--integration-us", a->integration_us, "of one sub-frame; default 1000");
  camera->add_option("--frequency-mhz", a->frequency_mhz, "modulation, or two as in 20+30; default 20");
  camera->add_option("--sun", a->sun_w_m2_nm, "W/m2/nm at 870 nm: on the wall, or the room's sun");
  camera->add_option("--effects", a->effects, "all (default), raw, ideal, or names: noise,adc or -noise");
  camera->add_flag("--nearest", a->nearest, "take the nearest valid settings instead of refusing");
  camera->add_option("--seed", a->seed, "of the noise; default 1")->check(WholeNumber);
  camera->add_option("--threads", a->threads, "any number gives the same bits; default 2")->check(CLI::Range(1, 256));
  camera->add_option("--out", a->out, "folder for the files; default runs/camera-<model>")->check(NotEmpty);
  camera->add_option(
      "--study", a->study,
      "instead, a figure: noise, wiggling, integration, flying, multipath, scatter, sun, glass or motion");
  camera->add_flag("--json", a->json, "print result.json instead of the summary");
  camera->callback([a, &exit_code] { exit_code = Camera(*a); });
}

}  // namespace merlin::cli
