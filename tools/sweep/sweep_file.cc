#include "tools/sweep/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <sstream>

#include "robot/base/nearest_name.h"
#include "robot/base/yaml_reader.h"
#include "scenarios/config/names.h"
#include "scenarios/run/twin_options.h"

namespace merlin {
namespace {

constexpr double kTimes = 1.5;             // time allowed for a lap over the time at full speed
constexpr std::size_t kSeedsMax = 10'000;  // most seeds in a row

// The value in the form that `--set` takes: on one line.
std::string OnOneLine(const YAML::Node& value) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << value;
  return out.c_str();
}

}  // namespace

// A map of settings whose keys are dotted paths. YamlReader finds this function by its argument types.
static void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field,
                     std::vector<Assignment>& set) {
  for (const YamlEntry& entry : reader.file().Entries(node, field))
    set.push_back({entry.key + "=" + OnOneLine(entry.value), reader.Where(entry.key_node, field + "." + entry.key)});
}

template <class Visitor>
static void Visit(Visitor& v, SweepRow& c) {
  v.Need("name", c.name);
  v("scenario", c.scenario);
  v("seeds", c.seeds);
  v("set", c.set);
  v("limits", c.limits);
  v("compared_with", c.compared_with);
}

static void ReadYaml(YamlReader& reader, const YAML::Node& node, const std::string& field, SweepRow& row) {
  row.where = reader.Where(node, field);
  YamlReader(reader.file(), node, field).ReadInto(row);
}

template <class Visitor>
static void Visit(Visitor& v, Sweep& c) {
  v.Need("scenario", c.scenario);
  v("lap_m", c.lap_m, Range{0.0, 1e6});
  v("seeds", c.seeds);
  v("set", c.set);
  v("limits", c.limits);
  v("all", c.all);
  v.Need("rows", c.rows);
}

namespace {

// Copies settings of the sweep to a row that does not have its own.
void Inherit(const Sweep& sweep, SweepRow& row) {
  if (row.scenario.empty()) row.scenario = sweep.scenario;
  if (row.seeds.empty()) row.seeds = sweep.seeds;
  row.set.insert(row.set.begin(), sweep.set.begin(), sweep.set.end());
  const auto take = [](std::optional<double>& own, const std::optional<double>& common) {
    if (!own) own = common;
  };
  take(row.limits.pass_share_min, sweep.limits.pass_share_min);
  take(row.limits.ate_median_m_max, sweep.limits.ate_median_m_max);
  take(row.limits.ate_worst_m_max, sweep.limits.ate_worst_m_max);
  take(row.limits.ate_median_ratio_max, sweep.limits.ate_median_ratio_max);
  take(row.limits.size_worst_percent_max, sweep.limits.size_worst_percent_max);
  take(row.limits.walls_worst_m_max, sweep.limits.walls_worst_m_max);
}

// All faults that would make a run refuse to start.
Scenario Resolve(const std::string& name, const std::vector<std::string>& sets) {
  Scenario scenario = ReadScenario(name, sets);
  const TwinOptions twin = TwinOptionsOf(scenario, {});
  CheckSettings(twin.depth.sheet, twin.depth.settings);
  return scenario;
}

std::vector<std::string> Texts(const std::vector<Assignment>& set) {
  std::vector<std::string> texts;
  for (const Assignment& assignment : set) texts.push_back(assignment.text);
  return texts;
}

std::string WithoutOptionsName(std::string line) {
  const std::string option = "--set: ";
  return line.starts_with(option) ? line.substr(option.size()) : line;
}

// Faults, each reported once although many rows share their settings.
class Faults {
 public:
  explicit Faults(YamlFile& yaml) : yaml_(yaml) {}

  void Add(const std::string& where, const std::string& lines) {
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);) {
      const std::string fault = where + ": " + WithoutOptionsName(line);
      if (std::ranges::find(known_, fault) != known_.end()) continue;
      known_.push_back(fault);
      yaml_.Add(InputError(fault));
    }
  }

  // Reports the settings that are wrong on their own; if there are none, the row as a whole.
  void AddOf(const SweepRow& row, const InputError& whole) {
    bool found = false;
    for (const Assignment& assignment : row.set) {
      try {
        ReadScenario(row.scenario, {assignment.text});
      } catch (const InputError& error) {
        Add(assignment.where, error.what());
        found = true;
      }
    }
    if (!found) Add(row.where, "row " + row.name + ": " + whole.what());
  }

 private:
  YamlFile& yaml_;
  std::vector<std::string> known_;
};

bool IsFolderName(const std::string& name) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_.+-", c); };
  return !name.empty() && name.size() <= 60 && name.front() != '.' && std::ranges::all_of(name, plain);
}

void CheckNames(const Sweep& sweep, Faults& faults) {
  std::vector<std::string> names;
  for (const SweepRow& row : sweep.rows) {
    if (!IsFolderName(row.name))
      faults.Add(row.where, "a row's name is letters, digits and _ . + -, at most 60; got '" + row.name + "'");
    if (row.name == "all") faults.Add(row.where, "a row may not be called 'all': that is the table's last row");
    if (std::ranges::find(names, row.name) != names.end()) faults.Add(row.where, "a second row '" + row.name + "'");
    names.push_back(row.name);
  }
  if (names.empty()) return;
  for (const SweepRow& row : sweep.rows)
    if (!row.compared_with.empty() && std::ranges::find(names, row.compared_with) == names.end())
      faults.Add(row.where, "compared_with: no row is called '" + row.compared_with + "'; did you mean '" +
                                NearestName(row.compared_with, names) + "'?");
}

// Sets the row's scenario and, if lap_m is given, its duration.
void AddRuns(const Sweep& sweep, std::size_t index, const std::string& seeds, std::vector<SweepRun>& runs) {
  const SweepRow& row = sweep.rows[index];
  SweepRun run{.row = index, .scenario = {}, .sets = Texts(row.set)};
  run.scenario = Resolve(row.scenario, run.sets);
  const auto sets_duration = [](const std::string& text) { return text.starts_with("duration_s="); };
  if (sweep.lap_m > 0.0 && std::ranges::none_of(run.sets, sets_duration)) {
    run.scenario.duration_s = kTimes * sweep.lap_m / run.scenario.pilot.behavior.follow_corridor.speed_m_s;
    run.sets.push_back(fmt::format("duration_s={}", run.scenario.duration_s));
  }
  for (const std::uint64_t seed : SeedsOf(seeds, "seeds")) {
    run.seed = run.scenario.seed = seed;
    runs.push_back(run);
  }
}

void CheckChoice(const Sweep& sweep, const SweepChoice& choice) {
  std::vector<std::string> names;
  for (const SweepRow& row : sweep.rows) names.push_back(row.name);
  for (const std::string& row : choice.rows)
    if (std::ranges::find(names, row) == names.end())
      throw InputError("--row", "no row is called '" + row + "'; did you mean '" + NearestName(row, names) + "'?");
}

// A scenario beside the sweep file takes precedence over one in the current folder.
void Anchor(std::string& scenario, const std::filesystem::path& folder) {
  std::error_code ignored;
  const bool is_path = scenario.ends_with(".yaml") || scenario.find('/') != std::string::npos;
  if (is_path && std::filesystem::is_regular_file(folder / scenario, ignored))
    scenario = (folder / scenario).lexically_normal().string();
}

}  // namespace

std::vector<std::uint64_t> SeedsOf(const std::string& text, const std::string& where) {
  const auto refuse = [&] {
    throw InputError(where, "not a list of seeds", "such as 1-5 or 1,4,7-9", "'" + text + "'");
  };
  const auto number = [&](const std::string& digits) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || digits.empty()) refuse();
    return value;
  };
  std::vector<std::uint64_t> seeds;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    std::erase(part, ' ');
    const std::size_t dash = part.find('-');
    const std::uint64_t first = number(part.substr(0, dash));
    const std::uint64_t last = dash == std::string::npos ? first : number(part.substr(dash + 1));
    if (last < first || last - first >= kSeedsMax) refuse();
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  }
  if (seeds.empty() || seeds.size() > kSeedsMax) refuse();
  return seeds;
}

Sweep ReadSweep(const std::string& name, const SweepChoice& choice) {
  if (!choice.seeds.empty()) SeedsOf(choice.seeds, "--seeds");
  const std::filesystem::path file = SweepFile(name);
  YamlFile yaml(file, "a sweep: scenario, seeds, set, rows, ...");
  Sweep sweep;
  yaml.ReadInto(sweep);
  yaml.ThrowFaults();  // without a valid sweep there are no rows to check
  if (sweep.rows.empty()) yaml.Fault("rows", "expected at least one row");
  Faults faults(yaml);
  CheckNames(sweep, faults);
  for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
    SweepRow& row = sweep.rows[i];
    Inherit(sweep, row);
    Anchor(row.scenario, file.parent_path());
    const bool taken = choice.rows.empty() || std::ranges::find(choice.rows, row.name) != choice.rows.end();
    try {
      std::vector<SweepRun> runs;
      SeedsOf(row.seeds, "seeds");
      AddRuns(sweep, i, choice.seeds.empty() ? row.seeds : choice.seeds, runs);
      if (taken) sweep.runs.insert(sweep.runs.end(), runs.begin(), runs.end());
    } catch (const InputError& error) {
      faults.AddOf(row, error);
    }
  }
  yaml.ThrowFaults();
  CheckChoice(sweep, choice);
  return sweep;
}

}  // namespace merlin
