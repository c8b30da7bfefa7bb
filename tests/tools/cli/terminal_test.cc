#include "tools/cli/terminal.h"

#include <gtest/gtest.h>

#include <random>

namespace merlin::cli {
namespace {

TEST(DisplayColumns, CountWhatATerminalTakes) {
  EXPECT_EQ(DisplayColumns(""), 0);
  EXPECT_EQ(DisplayColumns("Prüfung"), 7);
  EXPECT_EQ(DisplayColumns("走廊"), 4);        // wide characters: two columns each (Unicode Standard Annex 11)
  EXPECT_EQ(DisplayColumns("u\u0308ber"), 4);  // a combining diaeresis takes none
  EXPECT_EQ(DisplayColumns("\xff\x01\n"), 3);  // shown as '?'
}

TEST(Cut, KeepsWholeCharactersThatFit) {
  EXPECT_EQ(Cut("Prüfung", 3), "Prü");
  EXPECT_EQ(Cut("Prüfung", 7), "Prüfung");
  EXPECT_EQ(Cut("走廊", 3), "走");
  EXPECT_EQ(Cut("u\u0308b", 1), "u\u0308");
  EXPECT_EQ(Cut("a\tb\xC3", 9), "a?b?");
  EXPECT_EQ(Cut("abc", 0), "");
  EXPECT_EQ(Cut("abc", -1), "");
}

TEST(Wrap, BreaksAtBlanks) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(Wrap("", 10), Lines{""});
  EXPECT_EQ(Wrap("one two three", 7), (Lines{"one two", "three"}));
  EXPECT_EQ(Wrap("one two three", 6), (Lines{"one", "two", "three"}));
  EXPECT_EQ(Wrap("one  two", 0), Lines{"one two"});
  EXPECT_EQ(Wrap("a disproportionate word", 5), (Lines{"a", "disproportionate", "word"}));
  EXPECT_EQ(Wrap("über über", 4), (Lines{"über", "über"}));
}

TEST(Wrap, LosesNoWordAndFitsWhateverTheWidth) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    std::string text;
    for (int word = 0; word < 12; ++word) text += std::string(1 + random() % 5, 'x') + (word < 11 ? " " : "");
    const int columns = 5 + static_cast<int>(random() % 20);
    std::string joined;
    for (const std::string& line : Wrap(text, columns)) {
      EXPECT_LE(line.size(), static_cast<std::size_t>(columns));
      joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, text);
  }
}

}  // namespace
}  // namespace merlin::cli
