#include "tools/cli/usage.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "robot/base/nearest_name.h"
#include "tools/cli/terminal.h"

namespace merlin::cli {
namespace {

class Formatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override { return Wrapped(option->get_description()); }
  std::string make_description(const CLI::App* app) const override { return Paragraph(app->get_description()); }
  std::string make_footer(const CLI::App* app) const override { return Paragraph(app->get_footer()); }
  std::string make_subcommand(const CLI::App* sub) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, sub->get_display_name(true), Wrapped(sub->get_description()), get_column_width());
    return out.str();
  }

 private:
  static int Columns() {
    const int columns = TerminalColumns(STDOUT_FILENO);
    return columns > 0 ? columns : 80;
  }
  static std::string Paragraph(const std::string& text) {
    return text.empty() ? "" : fmt::format("{}\n", fmt::join(Wrap(text, Columns()), "\n"));
  }
  std::string Wrapped(const std::string& text) const {
    return fmt::format("{}",
                       fmt::join(Wrap(text, std::max(20, Columns() - static_cast<int>(get_column_width()))), "\n"));
  }
};

// The subcommand that was being read.
const CLI::App& Innermost(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : Innermost(*parsed.back());
}

std::vector<std::string> OptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> SubcommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

}  // namespace

std::shared_ptr<CLI::FormatterBase> HelpFormatter() { return std::make_shared<Formatter>(); }

std::string Explain(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return error.what();
  const CLI::App& sub = Innermost(app);
  const std::string word = unknown.front().substr(0, unknown.front().find('='));
  const bool is_option = word.starts_with('-');
  const std::vector<std::string> known = is_option ? OptionNames(sub) : SubcommandNames(sub);
  if (known.empty()) return error.what();
  return fmt::format("unknown {} '{}'; did you mean '{}'?", is_option ? "option" : "subcommand", word,
                     NearestName(word, known));
}

}  // namespace merlin::cli
