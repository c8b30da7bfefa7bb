#include "tools/cloud/cloud_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "robot/types/error.h"
#include "scenarios/judge/writers.h"
#include "tests/scenarios/judge/temporary_folder.h"

namespace merlin {
namespace {

using Parser = CloudFile (*)(std::string_view, const std::string&);

// The bytes of numbers, one after the other, low byte first; or high byte first.
template <class Number>
std::string Bytes(std::initializer_list<Number> numbers, bool big = false) {
  std::string bytes;
  for (const Number number : numbers) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &number, sizeof(Number));
    if (big) std::reverse(raw, raw + sizeof(Number));
    bytes.append(raw, sizeof(Number));
  }
  return bytes;
}

std::string PlyHeader(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment of ours\n" + elements + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string PcdHeader(const std::string& points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points +
         "\nHEIGHT 1\nPOINTS " + points + "\nDATA " + data + "\n";
}

void ExpectPoints(const CloudFile& file, const std::vector<Eigen::Vector3d>& positions) {
  ASSERT_EQ(file.cloud.size(), positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) EXPECT_EQ(file.cloud.positions[i], positions[i]) << i;
}

void ExpectRefused(Parser parse, const std::string& bytes, const std::string& part) {
  try {
    parse(bytes, "f");
    FAIL() << bytes.substr(0, 200);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST(Ply, IsReadInItsThreeFormats) {
  const std::vector<Eigen::Vector3d> points{{1, 2, 3}, {-4, 0.5, 6}};
  const std::string elements = "element vertex 2\n" + kXyz;
  ExpectPoints(ParsePly(PlyHeader("ascii", elements) + "1 2 3\n-4 5e-1 +6", "f"), points);
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    ExpectPoints(ParsePly(PlyHeader(format, elements) + Bytes<float>({1, 2, 3, -4, 0.5f, 6}, big), "f"), points);
    const std::string doubles = "element vertex 1\nproperty double x\nproperty double y\nproperty double z\n";
    ExpectPoints(ParsePly(PlyHeader(format, doubles) + Bytes<double>({0.1, 5.3e6, 1e-300}, big), "f"),
                 {{0.1, 5.3e6, 1e-300}});
    const std::string whole = "element vertex 1\nproperty short x\nproperty uchar y\nproperty int z\n";
    ExpectPoints(ParsePly(PlyHeader(format, whole) + Bytes<std::int16_t>({-300}, big) +
                              Bytes<std::uint8_t>({200}, big) + Bytes<std::int32_t>({-70000}, big),
                          "f"),
                 {{-300, 200, -70000}});
  }
  std::string dos = PlyHeader("ascii", elements) + "1 2 3\n-4 .5 6\n";
  for (std::size_t at = 0; (at = dos.find('\n', at)) != std::string::npos; at += 2) dos.replace(at, 1, "\r\n");
  ExpectPoints(ParsePly(dos, "f"), points);
}

TEST(Ply, GivesPositionsColoursAndSigmasAmongOtherPropertiesAndElements) {
  const std::string elements =
      "element camera 1\nproperty list uchar int views\nproperty double focal\nelement vertex 2\nproperty uchar "
      "red\nproperty float z\n"
      "property list uchar short tags\nproperty float y\nproperty float x\nproperty uchar green\nproperty uchar "
      "blue\nproperty float "
      "sigma_m\nelement face 1\nproperty list uchar int vertex_indices\n";
  const CloudFile text = ParsePly(
      PlyHeader("ascii", elements) + "2 7 8 0.5\n10 3 0 2 1 20 30 0.25\n40 6 2 9 9 5 4 50 60 0.5\n3 0 1 1\n", "f");
  const CloudFile binary =
      ParsePly(PlyHeader("binary_little_endian", elements) + Bytes<char>({2}) + Bytes<std::int32_t>({7, 8}) +
                   Bytes<double>({0.5}) + Bytes<char>({10}) + Bytes<float>({3}) + Bytes<char>({0}) +
                   Bytes<float>({2, 1}) + Bytes<char>({20, 30}) + Bytes<float>({0.25f}) + Bytes<char>({40}) +
                   Bytes<float>({6}) + Bytes<char>({2}) + Bytes<std::int16_t>({9, 9}) + Bytes<float>({5, 4}) +
                   Bytes<char>({50, 60}) + Bytes<float>({0.5f}) + Bytes<char>({3}) + Bytes<std::int32_t>({0, 1, 1}),
               "f");
  for (const CloudFile& file : {text, binary}) {
    ExpectPoints(file, {{1, 2, 3}, {4, 5, 6}});
    EXPECT_EQ(file.rgb, (std::vector<std::array<std::uint8_t, 3>>{{10, 20, 30}, {40, 50, 60}}));
    EXPECT_EQ(file.cloud.sigma_m, (std::vector<double>{0.25, 0.5}));
  }
}

TEST(Ply, OfOursIsReadBack) {
  const std::vector<MapPoint> map{{{1.0f, -2.0f, 0.1f}, {1, 2, 3}}, {{0.0f, 1e-20f, 5.0f}, {255, 0, 7}}};
  const CloudFile file = ParsePly(ToPly(map), "f");
  ExpectPoints(file, {map[0].p_map.cast<double>(), map[1].p_map.cast<double>()});
  EXPECT_EQ(file.rgb[1], map[1].rgb);
}

TEST(Ply, IsRefusedWithLineOrByte) {
  const std::string vertex = "element vertex 2\n" + kXyz, binary = PlyHeader("binary_little_endian", vertex);
  ExpectRefused(ParsePly, "", "f:1");
  ExpectRefused(ParsePly, "solid\n", "f:1: not a PLY file");
  ExpectRefused(ParsePly, "ply\nformat ascii 1.0\nelement vertex 2\n", "does not end");
  ExpectRefused(ParsePly, "ply\nelement vertex 2\n" + kXyz + "end_header\n", "no line format");
  ExpectRefused(ParsePly, PlyHeader("utf8", vertex), "f:2: no such format");
  ExpectRefused(ParsePly, PlyHeader("ascii", "element vertex -2\n" + kXyz), "f:4: no element");
  ExpectRefused(ParsePly, PlyHeader("ascii", "property float x\n"), "f:4: not a line");
  ExpectRefused(ParsePly, PlyHeader("ascii", "element vertex 1\nproperty quad x\n"), "f:5: no such type");
  ExpectRefused(ParsePly, PlyHeader("ascii", "element vertex 1\nproperty list float int x\n"), "f:5: a list's length");
  ExpectRefused(ParsePly, PlyHeader("ascii", "element vertex 1\nproperty float x\n") + "1\n", "f:4: no coordinates");
  ExpectRefused(ParsePly, PlyHeader("ascii", "element vertex 1\n" + kXyz + "property float x\n") + "1 2 3 4\n",
                "twice");
  ExpectRefused(ParsePly, PlyHeader("ascii", "element face 1\nproperty int a\n") + "1\n", "no points");
  ExpectRefused(ParsePly, PlyHeader("ascii", vertex) + "1 2 3\n40000 5\n", "f:10: fewer values");
  ExpectRefused(ParsePly, PlyHeader("ascii", vertex) + "1 2 3\n4 5 6 7\n", "f:10: another number");
  ExpectRefused(ParsePly, PlyHeader("ascii", vertex) + "1 2 3\n4 five 6\n", "f:10: no number, got 'five'");
  ExpectRefused(ParsePly, PlyHeader("ascii", vertex) + "100000 200000 3\n", "f:9: the file ends early");
  ExpectRefused(ParsePly, PlyHeader("ascii", vertex) + "1 2 3\n4 5 6\n7 8 9\n", "f:11: more data");
  ExpectRefused(ParsePly, binary + Bytes<float>({1, 2, 3, 4, 5}), "f:4: so many are not in the file");
  ExpectRefused(ParsePly, binary + Bytes<float>({1, 2, 3, 4, 5, 6, 7}), "byte 155: more data");
  const std::string list = "element vertex 1\n" + kXyz + "property list int int more\n";
  ExpectRefused(
      ParsePly,
      PlyHeader("binary_little_endian", list) + Bytes<float>({1, 2, 3}) + Bytes<std::int32_t>({2'000'000'000, 1}),
      "byte");
  ExpectRefused(ParsePly, PlyHeader("binary_little_endian", list) + Bytes<float>({1, 2, 3}) + Bytes<std::int32_t>({-1}),
                "negative");
  ExpectRefused(ParsePly, PlyHeader("ascii", list) + "1 2 3 5 1\n", "f:10: a list");
}

TEST(Ply, ClaimsOfMoreThanTheFileHoldsAskForNoMemory) {
  for (const char* count : {"1000000000", "18446744073709551615", "99999999999999999999999"})
    for (const char* format : {"ascii", "binary_little_endian"})
      for (const char* properties : {"property float x\nproperty float y\nproperty float z\n", ""})
        ExpectRefused(ParsePly,
                      PlyHeader(format, "element vertex " + std::string(count) + "\n" + properties) + "1 2 3\n", "f:4");
}

TEST(Pcd, IsReadAsTextAndBinary) {
  const std::vector<Eigen::Vector3d> points{{1, 2, 3}, {-4, 0.5, 6}};
  ExpectPoints(ParsePcd(PcdHeader("2", "ascii") + "1 2 3\n-4 0.5 6\n", "f"), points);
  ExpectPoints(ParsePcd(PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, -4, 0.5f, 6}), "f"), points);
  const std::string mixed =
      "VERSION .7\nFIELDS normal z h y x\nSIZE 4 8 1 2 4\nTYPE F F U I I\nCOUNT 3 1 2 1 1\nWIDTH 1\nHEIGHT "
      "1\nVIEWPOINT 0 0 0 1 0 0 0\n"
      "POINTS 1\nDATA binary\n";
  ExpectPoints(ParsePcd(mixed + Bytes<float>({9, 9, 9}) + Bytes<double>({0.1}) + Bytes<std::uint8_t>({8, 8}) +
                            Bytes<std::int16_t>({-2}) + Bytes<std::int32_t>({100000}),
                        "f"),
               {{100000, -2, 0.1}});
}

TEST(Pcd, IsRefusedWithLineOrByte) {
  const std::string rows = "1 2 3\n4 5 6\n";
  ExpectRefused(ParsePcd, "", "does not end");
  ExpectRefused(ParsePcd, "ply\n", "f:1: not a line of a PCD header");
  ExpectRefused(ParsePcd, PcdHeader("2", "binary_compressed"), "f:10: these data are not read");
  ExpectRefused(ParsePcd, PcdHeader("3", "ascii") + rows, "the file ends early; expected 3 points, got 2");
  ExpectRefused(ParsePcd, PcdHeader("1", "ascii") + rows, "f:12: more points");
  ExpectRefused(ParsePcd, PcdHeader("2", "ascii") + "1 2 3\n4 5\n", "f:12: another number");
  ExpectRefused(ParsePcd, PcdHeader("2", "ascii") + "1 2 3\n4 5 x\n", "f:12: no number");
  ExpectRefused(ParsePcd, PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, 4, 5}), "byte 109: not as many bytes");
  ExpectRefused(ParsePcd, PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, 4, 5, 6, 7}), "not as many bytes");
  ExpectRefused(ParsePcd, PcdHeader("1000000000", "binary") + "x", "not as many bytes");
  ExpectRefused(ParsePcd, PcdHeader("1000000000", "ascii") + rows, "ends early");
  ExpectRefused(ParsePcd, PcdHeader("-1", "ascii"), "f:7: WIDTH is no count");
  ExpectRefused(ParsePcd, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 2\nPOINTS 2\nDATA ascii\n" + rows,
                "f:6: POINTS");
  ExpectRefused(ParsePcd, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 9999999999\nHEIGHT 9999999999\nDATA ascii\n",
                "f:4");
  ExpectRefused(ParsePcd, "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n" + rows, "f:2: SIZE");
  ExpectRefused(ParsePcd, "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n" + rows,
                "f:3: no such type");
  ExpectRefused(ParsePcd,
                "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 999999999\nWIDTH 2\nHEIGHT 1\nDATA ascii\n" + rows,
                "f:4");
  ExpectRefused(ParsePcd, "FIELDS x y\nSIZE 4 4\nTYPE F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n1 2\n",
                "f:1: no coordinates");
  ExpectRefused(ParsePcd, "FIELDS x y z\nFIELDS x y z\nDATA ascii\n", "f:2: FIELDS is there twice");
  ExpectRefused(ParsePcd, "DATA ascii\n", "no line FIELDS");
}

TEST(Csv, IsReadWithAndWithoutHeaderAndBetweenAnything) {
  const std::vector<Eigen::Vector3d> points{{1, 2, 3}, {-4, 0.5, 6}};
  for (const char* text : {"1,2,3\n-4,0.5,6\n", "x,y,z\n1,2,3\n-4,.5,6", "X_m; Z_m; Y_m\r\n1; 3; 2\r\n-4; 6; 5e-1\r\n",
                           "# a remark\n\n1 2  3\n-4\t0.5 +6\n", "\"x\",\"y\",\"z\",\"i\"\n1,2,3,7\n-4,0.5,6,8\n",
                           "\xEF\xBB\xBFx,y,z\n1,2,3\n-4,0.5,6\n", "1,2,3,9,9\n-4,0.5,6,9,9\n"})
    ExpectPoints(ParseCsv(text, "f"), points);
  EXPECT_EQ(ParseCsv("x,y,z,sigma_m\n1,2,3,0.5\n", "f").cloud.sigma_m, std::vector<double>{0.5});
}

TEST(Csv, IsRefusedWithItsLine) {
  ExpectRefused(ParseCsv, "", "no points");
  ExpectRefused(ParseCsv, "\n# nothing\n", "no points");
  ExpectRefused(ParseCsv, "a,b,c\n1,2,3\n", "f:1: no coordinates");
  ExpectRefused(ParseCsv, "1,2\n3,4\n", "f:1: no coordinates");
  ExpectRefused(ParseCsv, "1,2,3\n4,5\n", "f:2: another number of columns");
  ExpectRefused(ParseCsv, "1,2,3\n4,5,six\n", "f:2: no number, got 'six'");
  ExpectRefused(ParseCsv, "1,2,3\n4,5,\n", "f:2: no number");
  ExpectRefused(ParseCsv, "1,2,3\n4,5,1e999\n", "f:2: no number");
  ExpectRefused(ParseCsv, "x,y,z,X\n1,2,3,4\n", "twice");
  ExpectRefused(ParseCsv, std::string("\x1b[2J\x00,2,3", 10), "f:1");
}

TEST(CloudFile, LeavesOutAndCountsPointsThatAreNone) {
  const CloudFile file =
      ParseCsv("x,y,z,sigma_m\n1,2,3,1\nnan,2,3,1\n1,inf,3,1\n1,2,-1e10,1\n1,2,3,0\n1,2,3,nan\n", "f");
  ExpectPoints(file, {{1, 2, 3}});
  EXPECT_EQ(file.left_out, 5u);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ParsePcd(PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, nan, nan, nan}), "f").left_out, 1u);
  EXPECT_EQ(ParsePly(PlyHeader("ascii", "element vertex 0\n" + kXyz), "f").cloud.size(), 0u);
}

TEST(CloudFile, IsChosenByItsEnding) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "a.CSV") << "1,2,3\n";
  ExpectPoints(ReadCloud(folder.path() / "a.CSV"), {{1, 2, 3}});
  std::filesystem::create_directory(folder.path() / "d.ply");
  std::ofstream(folder.path() / "a.stl") << "solid\n";
  for (const char* name : {"none.ply", "d.ply", "a.stl", "", "a"})
    EXPECT_THROW(ReadCloud(folder.path() / name), InputError) << name;
}

// Ten thousand mutations of sound files: each is read, or refused in one sentence; the sanitizers watch.
TEST(CloudFile, SurvivesMutations) {
  const std::string elements = "element vertex 2\n" + kXyz + "property list uchar short tags\n";
  const std::string binary_rows =
      Bytes<float>({1, 2, 3}) + Bytes<char>({1, 5, 0}) + Bytes<float>({4, 5, 6}) + Bytes<char>({0});
  const std::vector<std::pair<Parser, std::string>> seeds{
      {ParsePly, PlyHeader("ascii", elements) + "1 2 3 0\n4 5 6 1 7\n"},
      {ParsePly, PlyHeader("binary_little_endian", elements) + binary_rows},
      {ParsePly, PlyHeader("binary_big_endian", elements) + binary_rows},
      {ParsePcd, PcdHeader("2", "ascii") + "1 2 3\n4 5 6\n"},
      {ParsePcd, PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, 4, 5, 6})},
      {ParseCsv, "x,y,z,sigma_m\n1,2,3,1\n4,5,6,0.5\n"}};
  const std::vector<std::string> words{
      "-1",       "999999999", "nan",   "list",  "vertex", "\n",           " ",
      "property", "0",         "float", "COUNT", ",",      "end_header\n", std::string(1, '\0')};
  std::mt19937 random(20110501);
  const auto below = [&](std::size_t limit) { return random() % std::max<std::size_t>(1, limit); };
  int read = 0, refused = 0;
  for (int i = 0; i < 10000; ++i) {
    auto [parse, bytes] = seeds[below(seeds.size())];
    for (std::size_t n = 1 + below(3); n-- > 0;) {
      const std::size_t at = below(bytes.size());
      switch (below(5)) {
        case 0:
          if (!bytes.empty()) bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.resize(at);
          break;
        case 2:
          bytes.erase(at, 1 + below(20));
          break;
        case 3:
          bytes.insert(at, words[below(words.size())]);
          break;
        default:
          bytes.insert(at, bytes.substr(below(bytes.size()), below(40)));
      }
    }
    try {
      const CloudFile file = parse(bytes, "f");
      EXPECT_LE(file.cloud.size() + file.left_out, bytes.size());
      EXPECT_TRUE(file.cloud.sigma_m.empty() || file.cloud.sigma_m.size() == file.cloud.size());
      EXPECT_TRUE(file.rgb.empty() || file.rgb.size() == file.cloud.size());
      ++read;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 3000);
}

}  // namespace
}  // namespace merlin
