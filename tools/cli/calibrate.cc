// `merlin calibrate odometry`: wheel radius, wheelbase and steering offset from drives that were measured with a tape.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "perception/calibrate_odometry.h"
#include "robot/base/error.h"
#include "robot/description/description.h"
#include "scenarios/config/calibration.h"
#include "scenarios/config/names.h"
#include "scenarios/config/scenario.h"
#include "scenarios/judge/output_path.h"
#include "scenarios/judge/writers.h"
#include "tools/cli/commands.h"
#include "tools/json_text.h"
#if MERLIN_TWIN
#include "sim/world/true_car.h"
#include "tools/calibrate/test_drive.h"
#endif

namespace merlin::cli {
namespace {

struct CalibrateArguments {
  std::string drives, robot, scenario = "corridor_short", out = "calibration.yaml";
  std::vector<std::string> sets;
  bool study = false, json = false;
};

constexpr double kDegree = std::numbers::pi / 180.0;

OdometryCalibration Solve(const CarDescription& car, const MeasuredDrives& drives, const std::string& where) {
  OdometryCalibration found = CalibrateOdometry(car, drives);
  if (!found.problem.empty()) throw InputError(where, found.problem);
  return found;
}

void Print(const CarDescription& car, const OdometryCalibration& found, const CarDescription* true_car) {
  const auto row = [&](const char* name, const char* unit, double scale, double described, double value, double sigma,
                       double truth) {
    fmt::print("  {:<16} {:>9.3f} {:>9.3f} +- {:.3f} {:<4}{}\n", name, scale * described, scale * value, scale * sigma,
               unit, true_car == nullptr ? "" : fmt::format("{:>9.3f}", scale * truth));
  };
  const CarDescription none, &truth = true_car == nullptr ? none : *true_car;
  fmt::print("  {:<16} {:>9} {:>9}{:14}{}\n", "", "described", "found", "", true_car == nullptr ? "" : "true");
  row("wheel radius", "mm", 1e3, car.wheel_radius_m, found.value.wheel_radius_m, found.sigma.wheel_radius_m,
      truth.wheel_radius_m);
  row("wheelbase", "mm", 1e3, car.wheelbase_m, found.value.wheelbase_m, found.sigma.wheelbase_m, truth.wheelbase_m);
  row("steering offset", "deg", 1.0 / kDegree, 0.0, found.value.steering_offset_rad, found.sigma.steering_offset_rad,
      truth.steering_offset_rad);
}

void Finish(const CalibrateArguments& arguments, const CarDescription& car, const OdometryCalibration& found,
            const CarDescription* true_car) {
  WriteFile(arguments.out, ToYaml(found.value));
  if (arguments.json) {
    fmt::print("{}", JsonText({{"wheel_radius_m", found.value.wheel_radius_m},
                               {"wheelbase_m", found.value.wheelbase_m},
                               {"steering_offset_rad", found.value.steering_offset_rad},
                               {"residual_rms", found.residual_rms},
                               {"file", arguments.out}}));
    return;
  }
  Print(car, found, true_car);
  fmt::print(
      "  residuals: {:.2f} times the errors expected of tape and play\nfile: {} (for a scenario: car: {{calibration: "
      "{}}})\n",
      found.residual_rms, arguments.out, arguments.out);
}

#if MERLIN_TWIN

sim::WorldOptions TwinOf(const CalibrateArguments& arguments, std::vector<std::string> sets) {
  sets.insert(sets.end(), arguments.sets.begin(), arguments.sets.end());
  return OnOpenFloor(ReadScenario(arguments.scenario, sets));
}

int CalibrateTwin(const CalibrateArguments& arguments) {
  const sim::WorldOptions twin = TwinOf(arguments, {});
  CarDescription true_car = sim::TrueCar(twin.car, twin.drivetrain);
  true_car.steering_offset_rad = twin.drivetrain.steering_offset_rad;
  Finish(arguments, twin.car, Solve(twin.car, DriveAndMeasure(twin), "the twin's drives"), &true_car);
  return kPass;
}

// Calibrates a car with the errors of a careless assembly on every floor, and measures its odometry before and after.
int StudyOdometry(const CalibrateArguments& arguments) {
  constexpr double kLimit_percent = 1.0;
  const sim::Materials materials = sim::ReadMaterials(Home() / "models/materials.yaml");
  bool pass = true;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::string rows;
  for (const auto& [surface, material] : materials.by_name) {
    if (!surface.starts_with("floor_")) continue;
    if (interrupted) return kInterrupted;
    const sim::WorldOptions twin = TwinOf(
        arguments, {"car.drivetrain={wheel_radius_factor: 0.98, wheelbase_factor: 1.03, steering_offset_rad: 0.015}",
                    "car.drivetrain.surface=" + surface});
    const CarCalibration calibration = Solve(twin.car, DriveAndMeasure(twin), "the twin's drives on " + surface).value;
    for (const Manoeuvre& m : DriveManoeuvres(twin, calibration)) {
      const double before = 100.0 * m.error_before_m / m.path_m, after = 100.0 * m.error_after_m / m.path_m;
      pass = pass && after <= kLimit_percent;
      json.push_back({{"surface", surface},
                      {"manoeuvre", m.name},
                      {"path_m", m.path_m},
                      {"before_percent", before},
                      {"after_percent", after}});
      rows +=
          fmt::format("  {:<16} {:<20} {:>7.2f} m {:>9.2f} % {:>9.2f} %\n", surface, m.name, m.path_m, before, after);
    }
  }
  if (arguments.json)
    fmt::print("{}", JsonText(json));
  else
    fmt::print(
        "position error of the odometry at the end of a manoeuvre, in percent of its path; limit after calibration: "
        "{:g} %\n"
        "  {:<16} {:<20} {:>9} {:>11} {:>11}\n{}",
        kLimit_percent, "surface", "manoeuvre", "path", "before", "after", rows);
  return pass ? kPass : kFail;
}

#else

int CalibrateTwin(const CalibrateArguments&) { throw MachineError("this build has no twin (MERLIN_TWIN=OFF)"); }
int StudyOdometry(const CalibrateArguments&) { throw MachineError("this build has no twin (MERLIN_TWIN=OFF)"); }

#endif

int Calibrate(const CalibrateArguments& arguments) {
  const int sources =
      (arguments.drives.empty() ? 0 : 1) + (arguments.robot.empty() ? 0 : 1) + (arguments.study ? 1 : 0);
  if (sources != 1)
    throw InputError("calibrate odometry", "it needs one source of drives",
                     "one of a file of drives, --robot twin or --study", sources == 0 ? "none" : "several");
  if (arguments.study) return StudyOdometry(arguments);
  CheckOutputFile(arguments.out);
  if (!arguments.robot.empty()) return CalibrateTwin(arguments);
  const CarDescription car = ReadCar(CarFile(ReadScenario(arguments.scenario, arguments.sets).car.model));
  Finish(arguments, car, Solve(car, ReadDrives(arguments.drives), arguments.drives), nullptr);
  return kPass;
}

}  // namespace

void AddCalibrate(CLI::App& app, int& exit_code) {
  const auto a = std::make_shared<CalibrateArguments>();
  CLI::App* calibrate = app.add_subcommand("calibrate", "measures what the car's description only estimates");
  calibrate->require_subcommand(1);
  CLI::App* odometry =
      calibrate->add_subcommand("odometry", "wheel radius, wheelbase and steering offset, from drives");
  odometry->add_option("drives", a->drives,
                       "YAML: straights: [{encoder_counts, distance_m}], circles: [{steering_rad, diameter_m}]");
  odometry->add_option("--robot", a->robot, "twin: the twin drives and is measured, with the errors of a tape")
      ->check(CLI::IsMember({"twin"}));
  CLI::Option* study = odometry->add_flag(
      "--study", a->study, "the twin drives circles and squares on every floor, before and after calibration");
  odometry->add_option("--scenario", a->scenario, "whose car and seed; default corridor_short");
  odometry->add_option("--set", a->sets, "a.b=c, over the scenario's file; may be repeated")->allow_extra_args(false);
  odometry->add_option("--out", a->out, "default calibration.yaml; a scenario takes it as car.calibration")
      ->check(NotEmpty)
      ->excludes(study);
  odometry->add_flag("--json", a->json, "for machines");
  odometry->callback([a, &exit_code] { exit_code = Calibrate(*a); });
}

}  // namespace merlin::cli
