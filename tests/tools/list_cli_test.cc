// `merlin list` and progress lines fit the terminal.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "tests/tools/terminal.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

std::size_t Longest(const std::vector<std::string>& lines) {
  std::size_t longest = 0;
  for (const std::string& line : lines) longest = std::max(longest, line.size());
  return longest;
}

TEST(ListCli, SaysOneWholeSentenceOfEach) {
  const TemporaryFolder folder;
  const Outcome outcome = Merlin("list", folder.path());
  EXPECT_EQ(outcome.code, 0);
  int items = 0;
  for (const std::string& line : ScreenLines(outcome.said)) {
    if (!line.starts_with("  ")) continue;
    ++items;
    EXPECT_TRUE(line.ends_with('.')) << line;
    EXPECT_EQ(line.find("Origin of each number"), std::string::npos) << line;
  }
  EXPECT_GE(items, 9 + 11 + 6 + 2);
  EXPECT_NE(outcome.said.find("The car drives one lap of the closed-loop corridor, about 87 m at 0.5 m/s.\n"),
            std::string::npos);
  EXPECT_NE(outcome.said.find("which turns on a stand: the wall"), std::string::npos);  // a sentence of four lines
}

TEST(ListCli, WrapsToTheTerminal) {
  const TemporaryFolder folder;
  const Outcome wide = Merlin("list", folder.path());
  for (const unsigned short columns : {60, 80, 100}) {
    const Outcome outcome = OnTerminal("'" MERLIN_BINARY "' list", columns, folder.path());
    EXPECT_EQ(outcome.code, 0);
    EXPECT_LE(Longest(ScreenLines(outcome.said)), columns);
    const auto without_blanks = [](std::string text) {
      std::erase_if(text, [](char c) { return c == ' ' || c == '\n' || c == '\r'; });
      return text;
    };
    EXPECT_EQ(without_blanks(outcome.said), without_blanks(wide.said));
  }
  const Outcome told = OnTerminal("COLUMNS=60 '" MERLIN_BINARY "' list", 0, folder.path());
  EXPECT_LE(Longest(ScreenLines(told.said)), 60u);
}

TEST(ListCli, TakesTheFilesOfAHomeAsTheyAre) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "scenarios");
  fs::create_directories(folder.path() / "models/rooms");
  std::ofstream(folder.path() / "scenarios/prüfstand.yaml") << "# Die Prüfung der\n# Wände. Mehr nicht.\nroom: x\n";
  std::ofstream(folder.path() / "scenarios/bare.yaml") << "room: x\n";
  std::ofstream(folder.path() / "scenarios/latin.yaml") << "# K\xe4"
                                                           "fer.\nroom: x\n";
  std::ofstream(folder.path() / "models/rooms/attic.xml")
      << "<mujoco>\n<!--\n  An attic\n  with beams. -->\n</mujoco>\n";
  const Outcome outcome = merlin::Run("MERLIN_HOME=. '" MERLIN_BINARY "' list", folder.path());
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.said.find("  prüfstand            Die Prüfung der Wände.\n"), std::string::npos) << outcome.said;
  EXPECT_NE(outcome.said.find("  bare                 Its file begins with no comment"), std::string::npos)
      << outcome.said;
  EXPECT_NE(outcome.said.find("  latin                K?fer.\n"), std::string::npos) << outcome.said;
  EXPECT_NE(outcome.said.find("  attic                An attic with beams.\n"), std::string::npos) << outcome.said;
}

TEST(ProgressCli, FitsTheTerminal) {
  const TemporaryFolder folder;
  const Outcome outcome = OnTerminal(
      "'" MERLIN_BINARY "' run corridor_short --gl off --duration 3 --pace 3 --out o >printed", 30, folder.path());
  EXPECT_EQ(outcome.code, 1) << outcome.said;
  EXPECT_NE(outcome.said.find(" s of 3 s, "), std::string::npos) << outcome.said;
  EXPECT_EQ(Longest(ScreenLines(outcome.said)), 29u) << outcome.said;  // one column stays free
}

}  // namespace
}  // namespace merlin
