#include "robot/base/yaml_reader.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "robot/base/error.h"
#include "robot/base/yaml_writer.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

struct Wheel {
  double radius_m = 0.1;
  bool driven = false;
};
template <class Visitor>
void Visit(Visitor& v, Wheel& c) {
  v("radius_m", c.radius_m, {0.0, 1.0});
  v("driven", c.driven);
}

struct Toy {
  std::string name = "none";
  std::uint64_t seed = 1;
  int offset = 0;
  Wheel wheel;
  std::optional<Wheel> spare;
  std::vector<double> numbers;
  double anything = 0.0;
  double positive = 1.0;
  std::map<std::string, Wheel> by_name;
};
template <class Visitor>
void Visit(Visitor& v, Toy& c) {
  v("name", c.name);
  v("seed", c.seed);
  v("offset", c.offset, Range{-10, 10});
  v("wheel", c.wheel);
  v("spare", c.spare);
  v("numbers", c.numbers, Range{0, 5});
  v("anything", c.anything);
  v("positive", c.positive, kPositive);
  if constexpr (std::is_same_v<Visitor, YamlReader>) v("by_name", c.by_name);
}

struct Outcome {
  Toy toy;
  std::string said;  // without the file name
};

Outcome Read(const std::string& text, const std::vector<std::string>& sets = {}) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "f.yaml";
  std::ofstream(file, std::ios::binary) << text;
  Outcome outcome;
  try {
    YamlFile yaml(file, "a toy");
    for (const std::string& set : sets) yaml.Set(set);
    yaml.ReadInto(outcome.toy);
    yaml.ThrowFaults();
  } catch (const InputError& error) {
    outcome.said = error.what();
  }
  for (std::size_t at; (at = outcome.said.find(file)) != std::string::npos;) outcome.said.erase(at, file.size());
  return outcome;
}

TEST(YamlReader, FillsWhatTheFileGivesAndLeavesTheRest) {
  const Toy toy = Read(
                      "name: car\nseed: 18446744073709551615\nwheel: {radius_m: 0.5}\nspare: {}\nnumbers: [1, 2.5]\n"
                      "offset: -3\nby_name: {left: {driven: true}, right: {}}\n")
                      .toy;
  EXPECT_EQ(toy.name, "car");
  EXPECT_EQ(toy.seed, 18446744073709551615u);
  EXPECT_EQ(toy.offset, -3);
  EXPECT_EQ(toy.wheel.radius_m, 0.5);
  EXPECT_FALSE(toy.wheel.driven);
  ASSERT_TRUE(toy.spare);
  EXPECT_EQ(toy.spare->radius_m, 0.1);
  EXPECT_EQ(toy.numbers, (std::vector<double>{1.0, 2.5}));
  ASSERT_EQ(toy.by_name.size(), 2u);
  EXPECT_TRUE(toy.by_name.at("left").driven);
}

TEST(YamlReader, TakesAKeyWithoutAValueForNothingGiven) {
  const Outcome outcome = Read("wheel:\nspare:\nby_name:\n");
  EXPECT_EQ(outcome.said, "");
  EXPECT_FALSE(outcome.toy.spare);
}

TEST(YamlReader, NamesEveryFaultWithItsLineInTheOrderOfTheKeys) {
  const Outcome outcome = Read(
      "sed: 3\n"
      "name: [a]\n"
      "seed: -4\n"
      "offset: 2.5\n"
      "wheel:\n"
      "  radius_m: 1.5\n"
      "  driven: 7\n"
      "numbers:\n"
      "  - 1\n"
      "  - 5.5\n"
      "positive: 0\n"
      "anything: .inf\n");
  EXPECT_EQ(outcome.said,
            ":2: name: expected a text, got no single value\n"
            ":3: seed: expected a whole number, 0 or more, got '-4'\n"
            ":4: offset: expected a whole number, got '2.5'\n"
            ":6: wheel.radius_m: expected a number in [0, 1], got '1.5'\n"
            ":7: wheel.driven: expected true or false, got '7'\n"
            ":10: numbers[1]: expected a number in [0, 5], got '5.5'\n"
            ":12: anything: expected a finite number, got '.inf'\n"
            ":11: positive: expected a positive number, got '0'\n"
            ":1: sed: unknown key; did you mean 'seed'?");
  EXPECT_EQ(outcome.toy.wheel.radius_m, 0.1);  // a wrong value leaves what was there
}

TEST(YamlReader, RejectsTextThatIsNotANumber) {
  for (const std::string number : {".nan", "", "fast", "1.0 m", "[1]", "{a: 1}", "true"})
    EXPECT_NE(Read("wheel: {radius_m: " + number + "}\n").said.find(":1: wheel.radius_m: expected a number in [0, 1]"),
              std::string::npos)
        << number;
  for (const std::string number : {"0x10", "1e3", "+1", "1.0", "99999999999999999999", "", "11"})
    EXPECT_NE(Read("offset: " + number + "\n").said.find(":1: offset: expected a"), std::string::npos) << number;
  EXPECT_EQ(Read("name: x\noffset:\n").said, ":2: offset: expected a whole number, got nothing");
  EXPECT_EQ(Read("offset: 010\n").toy.offset, 10);
}

TEST(YamlReader, RefusesAKeyGivenTwiceAtEveryDepth) {
  EXPECT_EQ(Read("seed: 1\nseed: 2\n").said, ":2: seed: given twice");
  EXPECT_EQ(Read("wheel:\n  driven: true\n  driven: true\n").said, ":3: wheel.driven: given twice");
  EXPECT_EQ(Read("by_name:\n  a: {}\n  a: {}\n").said, ":3: by_name.a: given twice");
}

TEST(YamlReader, RefusesKeysThatAreNoNamesAndMapsThatAreNone) {
  EXPECT_EQ(Read("[a, b]: 1\n").said, ":1: a key that is no name");
  EXPECT_EQ(Read("wheel: 5\n").said, ":1: wheel: expected a map of keys, got '5'");
  EXPECT_EQ(Read("by_name: [1]\n").said, ":1: by_name: expected a map of keys, got no single value");
  EXPECT_EQ(Read("numbers: 5\n").said, ":1: numbers: expected a list, got '5'");
}

TEST(YamlReader, IgnoresByteOrderMarks) {
  EXPECT_EQ(Read("\xEF\xBB\xBFseed: 7\n").toy.seed, 7u);
  EXPECT_EQ(Read(std::string("\xFF\xFEs\0e\0e\0d\0:\0 \0007\0\n\0", 18)).toy.seed, 7u);  // UTF-16
}

TEST(YamlReader, NamesTheLineOfBrokenYamlAndWhatHoldsNoMap) {
  EXPECT_EQ(Read("seed: 1\nwheel: {\n  a: ]\n").said.substr(0, 16), ":3: broken YAML:");
  EXPECT_EQ(Read("").said, ": holds no map of keys; expected a toy");
  EXPECT_EQ(Read("- a\n").said, ": holds no map of keys; expected a toy");
  EXPECT_EQ(Read("seed: 1\n---\nseed: 2\n").said, ": holds more than one YAML document; expected a toy");
}

TEST(YamlReader, RefusesAFileThatCannotBeRead) {
  for (const std::string path : {"/no/such/file.yaml", "/tmp"}) {
    try {
      YamlFile(path, "a toy");
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), path + ": cannot be read; expected a toy");
    }
  }
}

TEST(YamlReader, SetsWriteOverTheFileAndOwnTheirFaults) {
  EXPECT_EQ(Read("seed: 1\n", {"seed=7"}).toy.seed, 7u);
  EXPECT_EQ(Read("seed: 1\n", {"seed=7", "seed=8"}).toy.seed, 8u);
  EXPECT_EQ(Read("seed: 1\n", {"wheel.radius_m=0.3", "numbers=[1, 2]"}).toy.wheel.radius_m, 0.3);
  EXPECT_EQ(Read("seed: 1\n", {"wheel.radius_m=3"}).said,
            "--set: wheel.radius_m: expected a number in [0, 1], got '3'");
  EXPECT_EQ(Read("seed: 1\n", {"numbers=[1, 9]"}).said, "--set: numbers[1]: expected a number in [0, 5], got '9'");
  EXPECT_EQ(Read("seed: 1\n", {"weel=3"}).said, "--set: weel: unknown key; did you mean 'wheel'?");
  EXPECT_EQ(Read("seed: 1\n", {"seed.x=3"}).said, "--set seed.x=3: 'seed' has no keys below it");
  for (const std::string text : {"seed", "=3", ""})
    EXPECT_EQ(Read("seed: 1\n", {text}).said, "--set: not an assignment; expected key.key=value, got '" + text + "'");
  EXPECT_NE(Read("seed: 1\n", {"seed=[1"}).said.find("--set seed=[1:1: broken YAML"), std::string::npos);
}

TEST(YamlFile, FindsTheLineOfAField) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "f.yaml";
  std::ofstream(file) << "a:\n  - {b: 1}\n  -\n    b: 2\n    c: 3\nd: 4\n";
  YamlFile yaml(file, "a toy");
  yaml.Fault("a[1].c", "bad");
  yaml.Fault("a[1].none", "bad");  // the nearest that there is: the map around it
  yaml.Fault("a[7].c", "bad");
  yaml.Fault("d.e", "bad");
  yaml.Require("a[0]", {"b", "c"});
  yaml.Require("", {"d", "e"});
  try {
    yaml.ThrowFaults();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file + ":5: a[1].c: bad\n" + file + ":4: a[1].none: bad\n" + file + ":2: a[7].c: bad\n" +
                                file + ":6: d.e: bad\n" + file + ":2: a[0]: missing key 'c'\n" + file +
                                ":1: missing key 'e'");
  }
}

TEST(YamlReader, AsksARuleOnlyOfValuesThatAreRightOnTheirOwn) {
  const auto says = [](const std::string& text) {
    const TemporaryFolder folder;
    const std::string file = folder.path() / "f.yaml";
    std::ofstream(file) << text;
    YamlFile yaml(file, "a toy");
    YamlReader reader(yaml, yaml.root(), "");
    const double low = reader.Number("low", {0, 10}), high = reader.Number("high", {0, 10});
    reader.Rule(low <= high, {"low", "high"}, "is above high");
    reader.RefuseUnknown();
    try {
      yaml.ThrowFaults();
    } catch (const InputError& error) {
      return std::string(error.what()).substr(file.size());
    }
    return std::string();
  };
  EXPECT_EQ(says("high: 3\nlow: 2\n"), "");
  EXPECT_EQ(says("high: 3\nlow: 4\n"), ":2: low: is above high");
  EXPECT_EQ(says("high: -3\nlow: 4\n"), ":1: high: expected a number in [0, 10], got '-3'");
  EXPECT_EQ(says("low: 4\n"), ":1: missing key 'high'");
}

TEST(YamlWriter, WritesWhatTheReaderReadsBack) {
  const Toy toy{.name = "a: b",
                .seed = 9,
                .offset = -2,
                .wheel = {0.123456789012345, true},
                .spare = {},
                .numbers = {1, 0.1},
                .anything = 1e-300,
                .positive = 2.0,
                .by_name = {}};
  const Toy again = Read(ToYamlText(toy, 17)).toy;
  EXPECT_EQ(again.name, toy.name);
  EXPECT_EQ(again.seed, toy.seed);
  EXPECT_EQ(again.offset, toy.offset);
  EXPECT_EQ(again.wheel.radius_m, toy.wheel.radius_m);
  EXPECT_EQ(again.wheel.driven, toy.wheel.driven);
  EXPECT_FALSE(again.spare);
  EXPECT_EQ(again.numbers, toy.numbers);
  EXPECT_EQ(again.anything, toy.anything);
}

}  // namespace
}  // namespace merlin
