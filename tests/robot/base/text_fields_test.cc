#include "robot/base/text_fields.h"

#include <gtest/gtest.h>

#include "robot/base/error.h"
#include "robot/base/fault_list.h"

namespace merlin {
namespace {

TEST(TextFields, AreWhatLiesBetweenBlanks) {
  TextFields fields("  one\ttwo  3 ", "f", 7);
  EXPECT_EQ(fields.Word(), "one");
  EXPECT_EQ(fields.Word(), "two");
  EXPECT_FALSE(fields.AtEnd());
  EXPECT_EQ(fields.Whole("n"), 3);
  EXPECT_TRUE(fields.AtEnd());
  EXPECT_EQ(fields.Word(), "");
  EXPECT_NO_THROW(fields.RequireEnd("a line"));
  EXPECT_EQ(fields.where(), "f:7");
}

TEST(TextFields, TakeNumbersAndNothingElse) {
  for (const auto& [text, number] : {std::pair("0", 0.0), std::pair("-1.5e-3", -1.5e-3), std::pair("+2", 2.0),
                                     std::pair(".5", 0.5), std::pair("5.", 5.0), std::pair("1e2", 100.0)})
    EXPECT_EQ(TextFields(text, "f", 1).Number("x", 1e3), number) << text;
  for (const char* text :
       {"", "nan", "-nan", "inf", "1e4", "-1e4", "1e999", "0x10", "1,5", "1e", "--1", "+-1", "+", "1.5x", "\xff"})
    EXPECT_THROW(TextFields(text, "f", 1).Number("x", 1e3), InputError) << text;
  for (const char* text : {"", "1.0", "1e3", "9223372036854775808", "x", "-", "+-1"})
    EXPECT_THROW(TextFields(text, "f", 1).Whole("n"), InputError) << text;
  EXPECT_EQ(TextFields("-9223372036854775808", "f", 1).Whole("n"), INT64_MIN);
}

TEST(TextFields, SayWhereAndWhat) {
  TextFields fields("1 x", "f.txt", 12);
  fields.Word();
  try {
    fields.Number("the height", 10.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "f.txt:12: the height; expected a number between -10 and 10, got 'x'");
  }
}

TEST(ForEachLine, NumbersLinesOfAnyEnding) {
  std::vector<std::pair<std::string, std::size_t>> lines;
  const auto add = [&lines](std::string_view line, std::size_t number) { lines.emplace_back(line, number); };
  ForEachLine("", add);
  EXPECT_TRUE(lines.empty());
  ForEachLine("a\r\n\nb\n", add);
  ForEachLine("c", add);
  EXPECT_EQ(lines, (std::vector<std::pair<std::string, std::size_t>>{{"a", 1}, {"", 2}, {"b", 3}, {"c", 1}}));
}

TEST(ForEachLine, IgnoresAByteOrderMarkAtTheStartOnly) {
  std::vector<std::string> lines;
  const auto add = [&lines](std::string_view line, std::size_t) { lines.emplace_back(line); };
  ForEachLine("\xEF\xBB\xBF", add);
  EXPECT_TRUE(lines.empty());
  ForEachLine("\xEF\xBB\xBF#\n\xEF\xBB\xBFx", add);
  ForEachLine("\xEF\xBB", add);  // an incomplete mark does not count
  EXPECT_EQ(lines, (std::vector<std::string>{"#", "\xEF\xBB\xBFx", "\xEF\xBB"}));
}

TEST(FaultList, NamesADozenFaultsAndCountsTheOthers) {
  FaultList faults("f.txt");
  EXPECT_TRUE(faults.empty());
  EXPECT_NO_THROW(faults.ThrowIfAny());
  EXPECT_TRUE(faults.Try([] {}));
  std::string expected;
  for (int line = 1; line <= 14; ++line) {
    const std::string where = "f.txt:" + std::to_string(line);
    EXPECT_FALSE(faults.Try([&] { throw InputError(where, "bad"); }));
    if (line <= 12) expected += where + ": bad\n";
  }
  try {
    faults.ThrowIfAny();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), expected + "f.txt: and 2 more");
  }
}

TEST(Quoted, CutsAndHidesWhatATerminalWouldObey) {
  EXPECT_EQ(Quoted("a\x1b[2Jb"), "'a?[2Jb'");
  EXPECT_EQ(Quoted(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(LinesOf, ListsADozenAtMost) {
  EXPECT_EQ(LinesOf({4}), "line 4");
  EXPECT_EQ(LinesOf({4, 7}), "lines 4, 7");
  EXPECT_EQ(LinesOf(std::vector<std::size_t>(13, 1)), "lines 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1 and more");
}

}  // namespace
}  // namespace merlin
