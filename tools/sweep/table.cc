#include "tools/sweep/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace merlin {
namespace {

void Judge(SweepFigures& figures, const SweepLimits& limits, const SweepFigures* compared) {
  const auto judge = [&](const char* name, const std::optional<double>& limit, std::optional<double> value,
                         bool is_max) {
    if (!limit) return;
    const bool kept = value && (is_max ? *value <= *limit : *value >= *limit);
    figures.limits.push_back({name, value, *limit, kept});
  };
  const auto median = [](const std::optional<Spread>& spread) {
    return spread ? std::optional(spread->median) : std::nullopt;
  };
  const auto worst = [](const std::optional<Spread>& spread) {
    return spread ? std::optional(spread->worst) : std::nullopt;
  };
  judge("pass_share_min", limits.pass_share_min, static_cast<double>(figures.passed) / figures.runs, false);
  judge("ate_median_m_max", limits.ate_median_m_max, median(figures.ate_m), true);
  judge("ate_worst_m_max", limits.ate_worst_m_max, worst(figures.ate_m), true);
  judge("size_worst_percent_max", limits.size_worst_percent_max, worst(figures.size_percent), true);
  judge("walls_worst_m_max", limits.walls_worst_m_max, worst(figures.walls_m), true);
  if (compared == nullptr) return;  // the other row was not run, so there is nothing to compare with
  std::optional<double> ratio;
  if (figures.ate_m && compared->ate_m && compared->ate_m->median > 0.0)
    ratio = figures.ate_m->median / compared->ate_m->median;
  judge("ate_median_ratio_max", limits.ate_median_ratio_max, ratio, true);
}

SweepFigures FiguresOf(const std::string& name, std::span<const SweepOutcome* const> outcomes) {
  SweepFigures figures{.name = name};
  std::vector<double> size_percent, walls_m;
  for (const SweepOutcome* outcome : outcomes) {
    ++figures.runs;
    figures.passed += outcome->passed;
    figures.completed += outcome->completed;
    if (!outcome->completed) continue;
    if (outcome->ate_rmse_m) figures.all_ate_m.push_back(*outcome->ate_rmse_m);
    if (outcome->size_error_percent) size_percent.push_back(*outcome->size_error_percent);
    if (outcome->map_to_plan_p95_m) walls_m.push_back(*outcome->map_to_plan_p95_m);
  }
  figures.ate_m = SpreadOf(figures.all_ate_m);
  figures.size_percent = SpreadOf(size_percent);
  figures.walls_m = SpreadOf(walls_m);
  return figures;
}

SweepFigures* Find(std::vector<SweepFigures>& rows, const std::string& name) {
  const auto row = std::ranges::find(rows, name, &SweepFigures::name);
  return row == rows.end() ? nullptr : &*row;
}

std::string Number(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

std::string Between(const Interval& interval, int digits) {
  return fmt::format("{:.{}f}-{:.{}f}", interval.low, digits, interval.high, digits);
}

std::string LimitText(const LimitOutcome& limit) {
  return fmt::format("{} {} (limit {:g})", limit.name, Number(limit.value, 3), limit.limit);
}

std::string MarkdownRow(const SweepFigures& row) {
  std::string missed;
  for (const LimitOutcome& limit : row.limits)
    if (!limit.kept) missed += (missed.empty() ? "" : "; ") + LimitText(limit);
  const auto worst = [](const std::optional<Spread>& spread, int digits) {
    return spread ? fmt::format("{:.{}f}", spread->worst, digits) : std::string("-");
  };
  const std::string ate =
      row.ate_m ? fmt::format("{:.3f} ({})", row.ate_m->median, Between(row.ate_m->of_median, 3)) : "-";
  return fmt::format("| {} | {}/{} | {} | {} | {} | {} | {} | {} | {} |\n", row.name, row.passed, row.runs,
                     Between(ShareInterval(row.passed, row.runs), 2), row.completed, ate, worst(row.ate_m, 3),
                     worst(row.size_percent, 2), worst(row.walls_m, 3),
                     row.limits.empty() ? "none"
                     : missed.empty()   ? "kept"
                                        : "MISSED: " + missed);
}

// A field in which commas and quotes are allowed (RFC 4180).
std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted;
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return "\"" + quoted + "\"";
}

std::string CsvNumber(const std::optional<double>& value) { return value ? fmt::format("{:g}", *value) : ""; }
std::string CsvNumber(const std::optional<int>& value) { return value ? std::to_string(*value) : ""; }

std::string CsvSpread(const std::optional<Spread>& spread) {
  if (!spread) return ",,,,";
  const Interval& interval = spread->of_median;
  return fmt::format("{:g},{:g},{:g},{:g},{:g}", spread->median, interval.low, interval.high, interval.confidence,
                     spread->worst);
}

}  // namespace

bool SweepTable::MissesALimit() const {
  return std::ranges::any_of(
      rows, [](const SweepFigures& row) { return !std::ranges::all_of(row.limits, &LimitOutcome::kept); });
}

SweepTable MakeTable(const std::string& name, const Sweep& sweep, std::span<const SweepOutcome> outcomes) {
  SweepTable table{.name = name};
  std::vector<std::vector<const SweepOutcome*>> of_row(sweep.rows.size());
  std::vector<const SweepOutcome*> all;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const SweepRun& run = sweep.runs[i];
    of_row[run.row].push_back(&outcomes[i]);
    all.push_back(&outcomes[i]);
    if (!outcomes[i].passed)
      table.failures.push_back(fmt::format("{} seed {}: {}", sweep.rows[run.row].name, run.seed, outcomes[i].why));
  }
  for (std::size_t i = 0; i < of_row.size(); ++i)
    if (!of_row[i].empty()) table.rows.push_back(FiguresOf(sweep.rows[i].name, of_row[i]));
  for (const SweepRow& row : sweep.rows)
    if (SweepFigures* const figures = Find(table.rows, row.name))
      Judge(*figures, row.limits, Find(table.rows, row.compared_with));
  table.rows.push_back(FiguresOf("all", all));
  Judge(table.rows.back(), sweep.all, nullptr);
  return table;
}

std::string ToMarkdown(const SweepTable& table) {
  std::string text = fmt::format(
      "# {}\n\n"
      "Path error (ATE), size and walls are those of completed runs. In brackets: the share's 95 % interval (Wilson), "
      "and the\n"
      "interval of the median between two of the values (95 %, or as wide as the values where they are too few).\n\n"
      "| row | passed | share | completed | ATE median [m] | ATE worst [m] | size worst [%] | walls p95 worst [m] | "
      "limits |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      table.name);
  for (const SweepFigures& row : table.rows) text += MarkdownRow(row);
  if (!table.failures.empty()) text += "\nRuns that did not pass:\n\n";
  for (const std::string& failure : table.failures) text += "- " + failure + "\n";
  return text;
}

std::string ToCsv(const SweepTable& table) {
  std::string text = "row,runs,passed,share_low,share_high,completed";
  for (const char* name : {"ate_m", "size_percent", "walls_m"})
    for (const char* figure : {"median", "median_low", "median_high", "median_confidence", "worst"})
      text += fmt::format(",{}_{}", name, figure);
  text += ",limits_missed\n";
  for (const SweepFigures& row : table.rows) {
    const Interval share = ShareInterval(row.passed, row.runs);
    std::string missed;
    for (const LimitOutcome& limit : row.limits)
      if (!limit.kept) missed += (missed.empty() ? "" : " ") + limit.name;
    text +=
        fmt::format("{},{},{},{:g},{:g},{},{},{},{},{}\n", row.name, row.runs, row.passed, share.low, share.high,
                    row.completed, CsvSpread(row.ate_m), CsvSpread(row.size_percent), CsvSpread(row.walls_m), missed);
  }
  return text;
}

std::string RunsToCsv(const Sweep& sweep, std::span<const SweepOutcome> outcomes) {
  std::string text =
      "row,seed,passed,completed,ate_rmse_m,size_error_percent,map_to_plan_p95_m,laps,loops_closed,collisions,distance_"
      "m,"
      "sim_time_s,wall_time_s,real_time_factor,why\n";
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const SweepOutcome& o = outcomes[i];
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", sweep.rows[sweep.runs[i].row].name,
                        sweep.runs[i].seed, o.passed ? 1 : 0, o.completed ? 1 : 0, CsvNumber(o.ate_rmse_m),
                        CsvNumber(o.size_error_percent), CsvNumber(o.map_to_plan_p95_m), CsvNumber(o.laps),
                        CsvNumber(o.loops_closed), CsvNumber(o.collisions), CsvNumber(o.distance_m),
                        CsvNumber(o.sim_time_s), CsvNumber(o.wall_time_s), CsvNumber(o.real_time_factor), Field(o.why));
  }
  return text;
}

}  // namespace merlin
