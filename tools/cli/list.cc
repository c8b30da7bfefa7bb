// `merlin list`: what there is, one line each.
#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <string>

#include "autonomy/pilot.h"
#include "scenarios/names.h"
#include "tools/cli/commands.h"

namespace merlin::cli {
namespace {

// The first comment of a YAML or MJCF file: what it is, in its author's words.
std::string FirstComment(const std::filesystem::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t word = line.find_first_not_of("#<!- ");
    if (word != std::string::npos) return line.substr(word, line.find(" -->") - word);
  }
  return "";
}

template <class FileOf>
void Print(const std::string& kind, const std::vector<std::string>& names, FileOf file_of) {
  fmt::print("{}\n", kind);
  for (const std::string& name : names) fmt::print("  {:<20} {}\n", name, FirstComment(file_of(name)));
}

void List(const std::string& kind) {
  const bool all = kind.empty();
  if (all || kind == "scenarios") Print("scenarios", ScenarioNames(), ScenarioFile);
  if (all || kind == "cameras") Print("cameras", CameraNames(), CameraFile);
  if (all || kind == "rooms") Print("rooms", RoomNames(), RoomFile);
  if (!all && kind != "behaviors") return;
  fmt::print("behaviors\n");
  for (const std::string& name : BehaviorNames()) fmt::print("  {}\n", name);
}

}  // namespace

void AddList(CLI::App& app, int&) {
  const auto kind = std::make_shared<std::string>();
  CLI::App* list = app.add_subcommand("list", "what there is, one line each");
  list->add_option("kind", *kind, "scenarios, cameras, rooms or behaviors; default all")
      ->check(CLI::IsMember({"scenarios", "cameras", "rooms", "behaviors"}));
  list->callback([kind] { List(*kind); });
}

}  // namespace merlin::cli
