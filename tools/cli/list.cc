// `merlin list`: lists scenarios, sweeps, cameras, rooms and behaviors, with one sentence about each.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "autonomy/behaviors/table.h"
#include "scenarios/config/names.h"
#include "tools/cli/commands.h"
#include "tools/cli/description.h"
#include "tools/cli/terminal.h"

namespace merlin::cli {
namespace {

struct Item {
  std::string name, sentence;
};

template <class FileOf>
std::vector<Item> ItemsOf(const std::vector<std::string>& names, FileOf file_of) {
  constexpr std::size_t kHead_bytes = 20'000;  // the description comes first
  std::vector<Item> items;
  for (const std::string& name : names) {
    std::string head(kHead_bytes, ' ');
    std::ifstream in(file_of(name), std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    const std::string sentence = FirstSentence(head);
    items.push_back({name, sentence.empty() ? "Its file begins with no comment that says what it is." : sentence});
  }
  return items;
}

std::vector<Item> BehaviorItems() {
  std::vector<Item> items;
  for (const BehaviorInfo& behavior : Behaviors()) items.push_back({behavior.name, behavior.description});
  return items;
}

// On a terminal the sentences are wrapped beside the names; elsewhere each item is one line, for grep.
void Print(const std::string& kind, const std::vector<Item>& items) {
  constexpr int kLeastText_columns = 30;
  int names_columns = 20;
  for (const Item& item : items) names_columns = std::max(names_columns, DisplayColumns(item.name));
  const int indent = 2 + names_columns + 1, columns = TerminalColumns(STDOUT_FILENO);
  fmt::print("{}\n", kind);
  for (const Item& item : items) {
    const std::string name = Cut(item.name, names_columns);
    const std::string gap(static_cast<std::size_t>(names_columns + 1 - DisplayColumns(name)), ' ');
    fmt::print("  {}{}", name, gap);
    const auto lines = Wrap(item.sentence, columns == 0 ? 0 : std::max(columns - indent, kLeastText_columns));
    fmt::print("{}\n", fmt::join(lines, "\n" + std::string(static_cast<std::size_t>(indent), ' ')));
  }
}

void List(const std::string& kind) {
  const bool all = kind.empty();
  if (all || kind == "scenarios") Print("scenarios", ItemsOf(ScenarioNames(), ScenarioFile));
  if (all || kind == "sweeps") Print("sweeps", ItemsOf(SweepNames(), SweepFile));
  if (all || kind == "cameras") Print("cameras", ItemsOf(CameraNames(), CameraFile));
  if (all || kind == "rooms") Print("rooms", ItemsOf(RoomNames(), RoomFile));
  if (all || kind == "behaviors") Print("behaviors", BehaviorItems());
}

}  // namespace

void AddList(CLI::App& app, int&) {
  const auto kind = std::make_shared<std::string>();
  CLI::App* list = app.add_subcommand("list", "what there is, one whole sentence each");
  list->add_option("kind", *kind, "scenarios, sweeps, cameras, rooms or behaviors; default all")
      ->check(CLI::IsMember({"scenarios", "sweeps", "cameras", "rooms", "behaviors"}));
  list->callback([kind] { List(*kind); });
}

}  // namespace merlin::cli
