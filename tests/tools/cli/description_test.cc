#include "tools/cli/description.h"

#include <gtest/gtest.h>

namespace merlin::cli {
namespace {

TEST(FirstSentence, MaySpanLinesAndEndsAtItsFullStop) {
  EXPECT_EQ(FirstSentence("# The car drives 2.5 m\n# and stops. It then waits.\nroom: hall\n"),
            "The car drives 2.5 m and stops.");
  EXPECT_EQ(FirstSentence("<!--\n  A hall for\n  tests. Origin: middle.\n-->\n<mujoco/>"), "A hall for tests.");
  EXPECT_EQ(FirstSentence("<!-- One line. -->\n<mujoco/>"), "One line.");
  EXPECT_EQ(FirstSentence("# Does it drive? It does.\n"), "Does it drive?");
  EXPECT_EQ(FirstSentence("# It maps a wall (7 m.) It turns.\n"), "It maps a wall (7 m.)");
}

TEST(FirstSentence, IsNotCutAtNumbersAndAbbreviations) {
  for (const std::string sentence : {"A PMD CamCube 2.0 at 0.5 m/s.", "A room, e.g. Room No. 5, of Dr. Meyer.",
                                     "Ein Flur, z. B. Haus A, ca. 3 m lang.", "The wall (cf. Fig. 2) is 3 m."})
    EXPECT_EQ(FirstSentence("# " + sentence + " Another one.\n"), sentence);
}

TEST(FirstSentence, EndsWithItsParagraphWhereNoFullStopDoes) {
  EXPECT_EQ(FirstSentence("# My room\n#\n# Drawn in 2024.\nroom: x"), "My room");
  EXPECT_EQ(FirstSentence("# My room\n\n# Drawn in 2024.\nroom: x"), "My room");
  EXPECT_EQ(FirstSentence("# My room\nroom: x # hall."), "My room");
  EXPECT_EQ(FirstSentence("<!-- My room\n\n Drawn. --><mujoco/>"), "My room");
}

TEST(FirstSentence, IsFoundBehindMarksAndFrames) {
  EXPECT_EQ(FirstSentence("\xEF\xBB\xBF# Prüfstand in Köln.\r\n"), "Prüfstand in Köln.");
  EXPECT_EQ(FirstSentence("%YAML 1.2\n---\n\n##########\n## A hall. ##\n##########\nroom: x\n"), "A hall.");
  EXPECT_EQ(FirstSentence("<?xml version=\"1.0\"?>\n<!-- A hall. -->\n<mujoco/>"), "A hall.");
  EXPECT_EQ(FirstSentence("<mujoco model=\"x\">\n  <!-- A hall. -->\n</mujoco>"), "A hall.");
}

TEST(FirstSentence, IsEmptyWhereTheFileBeginsWithNoComment) {
  for (const char* text : {"", " \n", "room: hall\n# late\n", "<mujoco><worldbody/><!-- late --></mujoco>", "<mujoco",
                           "<", "<!--", "#\n#\n", "<!-- -->", "<mujoco/>"})
    EXPECT_EQ(FirstSentence(text), "") << text;
}

}  // namespace
}  // namespace merlin::cli
