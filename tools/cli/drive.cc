// `merlin drive`: manual driving. The car maps as it goes, and the same files are written as by a run.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "robot/hardware/operator/joystick_device.h"
#include "scenarios/config/names.h"
#include "scenarios/config/scenario.h"
#include "scenarios/judge/output_folder.h"
#include "tools/cli/commands.h"
#include "tools/cli/robots.h"
#include "tools/cli/terminal.h"
#include "tools/drive/keys.h"
#include "tools/drive/raw_terminal.h"
#include "tools/drive/stick.h"
#if MERLIN_TWIN
#include "tools/drive/radio_hand.h"
#endif

namespace merlin::cli {
namespace {

struct DriveArguments {
  std::string scenario = "corridor_loop", out, robot = "twin", gl = "auto", joystick, seed;
  std::string duration_s = "3600";  // checked when the scenario is read
  double speed_m_s = HandLimits{}.speed_m_s;
  int threads = 0, radio_baud = 0;
  std::vector<std::string> sets;
  bool keyboard = false, autonomy = false;
};

constexpr char kKeysHelp[] =
    "w a s d or arrows drive, space stops, p autonomy, Shift overrides the obstacle stop, q quits\n";
constexpr char kStickHelp[] = "stick drives, button 0 overrides the obstacle stop, button 1 autonomy, button 7 quits\n";

// The operator's input device.
class Station {
 public:
  Station(const DriveArguments& arguments, const HandLimits& limits) : keys_(limits), stick_(limits) {
    if (arguments.joystick.empty())
      terminal_.emplace(STDIN_FILENO);
    else
      joystick_.emplace(arguments.joystick);
    fmt::print(stderr, "{}", joystick_ ? kStickHelp : kKeysHelp);
  }
  ManualCommand Wish(Time now) {
    if (joystick_) {
      const bool there = joystick_->Read();
      return stick_.Update(joystick_->state(), there, now);
    }
    keys_.Feed(terminal_->Read(), now);
    ManualCommand wish = keys_.Wish(now);
    wish.quit = wish.quit || !terminal_->there();
    return wish;
  }

 private:
  Keys keys_;
  Stick stick_;
  std::optional<JoystickDevice> joystick_;
  std::optional<RawTerminal> terminal_;
};

// The operator's display: updated five times a second on a terminal, once a second elsewhere, and at once when control
// changes.
class StatusLine {
 public:
  void Show(const LoopState& state) {
    const bool changed = state.arbitration.driver != driver_;
    driver_ = state.arbitration.driver;
    if (state.now < next_ && !changed) return;
    next_ = state.now + std::chrono::milliseconds(line_.on_terminal() ? 200 : 1000);
    const char* battery = state.energy == EnergyLevel::kEnough ? ""
                          : state.energy == EnergyLevel::kLow  ? " LOW"
                                                               : " EMPTY";
    const std::string doing = driver_ == Driver::kAutonomy ? ": " + Doing(state) : "";
    line_.Show(fmt::format("{:7.1f} s  {:5.2f} m/s  steering {:+5.1f} deg  battery {:5.2f} V{}  {}{}",
                           Seconds(state.now - state.began), state.speed_m_s,
                           state.drive.steering_rad * 180.0 / std::numbers::pi, state.drive.battery_v, battery,
                           Name(driver_), doing));
  }
  ~StatusLine() { line_.Keep(); }

 private:
  Time next_{0};
  Driver driver_ = Driver::kNobody;
  ProgressLine line_;
};

RunOptions OptionsOf(const DriveArguments& arguments, PlugMaker& make_plug) {
  RunOptions options;
  options.name = std::filesystem::path(arguments.scenario).stem().string();
  std::vector<std::string> sets = arguments.sets;
  if (!arguments.seed.empty()) sets.push_back("seed=" + arguments.seed);
  sets.push_back("duration_s=" + arguments.duration_s);
  sets.push_back("checks={}");  // the checks of the scenario are made for the pilot
  options.scenario = ReadScenario(arguments.scenario, sets);
  make_plug = PlugOf(arguments.robot, options);
  if (options.robot == RobotKind::kTwin) options.pace = 1.0;  // the other robots run in real time anyway
  options.out = arguments.out.empty() ? std::filesystem::path("runs") / (options.name + "-drive")
                                      : std::filesystem::path(arguments.out);
  options.gl = GlOf(arguments.gl);
  options.threads = arguments.threads;
  OutputFolder::Check(options.out);
  return options;
}

// The path of the operator's commands to the car.
using Transmit = std::function<ManualCommand(const ManualCommand&, Time now)>;

Transmit RadioOf(int baud, [[maybe_unused]] const HandLimits& limits, [[maybe_unused]] std::uint64_t seed) {
  if (baud == 0) return [](const ManualCommand& wish, Time) { return wish; };
#if MERLIN_TWIN
  return [radio = std::make_shared<RadioHand>(RadioConfig{.baud = baud}, limits, seed)](
             const ManualCommand& wish, Time now) { return radio->Send(wish, now); };
#else
  throw InputError("--radio", "this program was built without the twin, and has no model of a radio");
#endif
}

int Drive(const DriveArguments& arguments) {
  PlugMaker make_plug;
  RunOptions options = OptionsOf(arguments, make_plug);
  const CarDescription car = ReadCar(CarFile(options.scenario.car.model));
  const HandLimits limits{std::min(arguments.speed_m_s, car.drivetrain.speed_max_m_s), car.steering_max_rad};
  const Transmit transmit = RadioOf(arguments.radio_baud, limits, options.scenario.seed);
  RunReport report;
  {
    StatusLine line;
    Station station(arguments, limits);
    options.manual = [&](Time now) {
      ManualCommand wish = station.Wish(now);
      wish.autonomy = wish.autonomy && arguments.autonomy;
      return transmit(wish, now);
    };
    options.station = [&line](const LoopState& state) { line.Show(state); };
    report = RunScenario(options, make_plug, interrupted);
  }
  const RunResult& result = report.result;
  if (!result.fault.empty()) fmt::print("stopped: {}\n", result.fault);
  if (!report.note.empty()) fmt::print("note: {}\n", report.note);
  const auto collisions = result.metrics.collisions;
  fmt::print("drove {:.2f} m in {:.1f} s{}\nfiles: {} (look at map.png)\n", result.metrics.distance_m.value_or(0.0),
             result.metrics.sim_time_s.value_or(0.0), collisions ? fmt::format(", {} collisions", *collisions) : "",
             options.out.string());
  std::fflush(stdout);  // print what was reported so far before the error
  if (report.error) std::rethrow_exception(report.error);
  return ExitCodeOf(result.verdict);
}

std::string TopSpeed(const std::string& text) {
  double speed_m_s = 0.0;  // CLI11 rejects text that is not a number
  const bool number = CLI::detail::lexical_cast(text, speed_m_s);
  return number && speed_m_s >= 0.05 && speed_m_s <= 2.0 ? "" : "expected 0.05 to 2 m/s, got '" + text + "'";
}

}  // namespace

void AddDrive(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<DriveArguments>();
  CLI::App* drive = app.add_subcommand("drive", "drives by hand, in real time; the car maps as it goes");
  drive->add_option("scenario", arguments->scenario, "where: a name in scenarios/, or a path; default corridor_loop");
  CLI::Option* joystick = drive->add_option("--joystick", arguments->joystick,
                                            "a device such as /dev/input/js0, or a named pipe with its events");
  drive
      ->add_flag("--keyboard", arguments->keyboard,
                 "this terminal's keys (default): w a s d or arrows drive, space stops, q quits")
      ->excludes(joystick);
  drive->add_flag("--autonomy", arguments->autonomy, "key p or button 1 lets the pilot drive while nobody steers");
  drive->add_option("--robot", arguments->robot, "twin (default), emulated, or hardware:FILE; see run --help");
  drive
      ->add_option("--radio", arguments->radio_baud,
                   "the hand's commands go through the model of the car's radio, at this baud rate")
      ->check(CLI::IsMember({9600, 19200, 57600, 115200}));
  drive->add_option("--speed", arguments->speed_m_s, "m/s at full stick; default 0.8")->check(TopSpeed);
  drive->add_option("--duration", arguments->duration_s, "seconds after which it ends; default 3600");
  drive->add_option("--seed", arguments->seed, "of all randomness; default the scenario's")->check(WholeNumber);
  drive->add_option("--out", arguments->out, "folder for the results; default runs/<scenario>-drive")->check(NotEmpty);
  drive->add_option("--gl", arguments->gl, "how colour is drawn; off: depth only")
      ->check(CLI::IsMember({"auto", "egl", "osmesa", "off"}));
  drive
      ->add_option("--threads", arguments->threads,
                   "same bits for any number; default: one for the loop, and one for each camera")
      ->check(CLI::Range(1, 256));
  drive->add_option("--set", arguments->sets, "a.b=c, over the scenario's file; may be repeated")
      ->allow_extra_args(false);
  drive->callback([arguments, &exit_code] { exit_code = Drive(*arguments); });
}

}  // namespace merlin::cli
