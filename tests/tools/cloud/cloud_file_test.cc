#include "tools/cloud/cloud_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "robot/base/error.h"
#include "robot/base/text_fields.h"
#include "scenarios/judge/writers.h"
#include "tests/support/temporary_folder.h"

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
    ForEachLine(error.what(), [](std::string_view line, std::size_t) { EXPECT_TRUE(line.starts_with("f")) << line; });
  }
}

std::string Warning(const CloudFile& file) {
  EXPECT_EQ(file.warnings.size(), 1u);
  return file.warnings.empty() ? "" : file.warnings[0];
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

TEST(Ply, LeavesBytesBehindBinaryDataWithAWarning) {
  const std::string elements = "element vertex 1\n" + kXyz;
  for (const std::string& more : {std::string(5, '\0'), std::string("\nend\n")}) {
    const CloudFile file = ParsePly(PlyHeader("binary_little_endian", elements) + Bytes<float>({1, 2, 3}) + more, "f");
    ExpectPoints(file, {{1, 2, 3}});
    EXPECT_EQ(Warning(file), "f: 5 bytes behind the data that the header announces are not read");
  }
}

// 0.8, 0.4, 0.2 of 255 are 204, 102, 51; of 65535 are 52428, 26214, 13107.
TEST(Ply, GivesColoursOfAnyTypeAndName) {
  using Rgb = std::vector<std::array<std::uint8_t, 3>>;
  const auto read = [](const std::string& type, const std::string& r, const std::string& g, const std::string& b,
                       const std::string& values) {
    const std::string p = "property " + type + " ";
    return ParsePly(PlyHeader("ascii", "element vertex 2\n" + kXyz + p + r + "\n" + p + g + "\n" + p + b + "\n") +
                        "0 0 0 " + values + "\n1 1 1 0 0 0\n",
                    "f")
        .rgb;
  };
  const Rgb expected{{204, 102, 51}, {0, 0, 0}};
  for (const auto& [r, g, b] : {std::array{"red", "green", "blue"}, std::array{"r", "g", "b"},
                                std::array{"Diffuse_Red", "diffuse_green", "diffuse_blue"}}) {
    EXPECT_EQ(read("float", r, g, b, "0.8 0.4 0.2"), expected);
    EXPECT_EQ(read("double", r, g, b, "0.8 0.4 0.2"), expected);
    EXPECT_EQ(read("float", r, g, b, "204 102 51"), expected);
    EXPECT_EQ(read("uchar", r, g, b, "204 102 51"), expected);
    EXPECT_EQ(read("ushort", r, g, b, "52428 26214 13107"), expected);
    EXPECT_EQ(read("ushort", r, g, b, "204 102 51"), expected);
  }
  EXPECT_EQ(read("float", "r", "g", "b", "1 0 1"), (Rgb{{255, 0, 255}, {0, 0, 0}}));
  EXPECT_EQ(read("uchar", "r", "g", "b", "1 0 1"), (Rgb{{1, 0, 1}, {0, 0, 0}}));
  EXPECT_EQ(read("float", "r", "g", "b", "nan -1 inf"), (Rgb{{0, 0, 255}, {0, 0, 0}}));
  EXPECT_TRUE(read("uchar", "red", "green", "u", "1 2 3").empty());
}

TEST(Ply, NamesEveryFaultAtOnce) {
  ExpectRefused(ParsePly, PlyHeader("ascii", "element vertex 3\n" + kXyz) + "1.000 2.000\nx 2.000 3.000\n",
                "f:9: fewer values than properties\nf:10: no number, got 'x'\nf:10: the file ends early");
  ExpectRefused(ParsePly, PlyHeader("utf8", "element vertex -2\nproperty quad x\n"),
                "f:2: no such format; expected ascii, binary_little_endian or binary_big_endian, got 'utf8'\n"
                "f:4: no element; expected element NAME COUNT\nf:5: no such type");
}

TEST(Pcd, LeavesBytesBehindBinaryDataWithAWarning) {
  const CloudFile file = ParsePcd(PcdHeader("1", "binary") + Bytes<float>({1, 2, 3}) + std::string(4096, '\0'), "f");
  ExpectPoints(file, {{1, 2, 3}});
  EXPECT_EQ(Warning(file), "f: 4096 bytes behind the data that the header announces are not read");
}

// The bytes of each field for all points, one field after the other, as literal runs.
TEST(Pcd, IsReadCompressed) {
  const std::string x = Bytes<float>({1, -4}), y = Bytes<float>({2, 0.5f}), z = Bytes<float>({3, 6});
  const std::string data = Bytes<std::uint32_t>({25, 24}) + "\x17" + x + y + z;
  ExpectPoints(ParsePcd(PcdHeader("2", "binary_compressed") + data, "f"), {{1, 2, 3}, {-4, 0.5, 6}});
  EXPECT_NE(Warning(ParsePcd(PcdHeader("2", "binary_compressed") + data + "123", "f")).find("3 bytes"),
            std::string::npos);
  ExpectPoints(ParsePcd(PcdHeader("0", "binary_compressed") + Bytes<std::uint32_t>({0, 0}), "f"), {});

  const std::string mixed =
      "VERSION .7\nFIELDS normal y x z\nSIZE 1 8 4 2\nTYPE U F F I\nCOUNT 3 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n"
      "DATA binary_compressed\n" +
      Bytes<std::uint32_t>({36, 34}) + "\x1f" + "abcABC" + Bytes<double>({0.1, 5.6e6}) + Bytes<float>({1, 2}) +
      Bytes<std::int16_t>({7}) + "\x01" + Bytes<std::int16_t>({-8});
  ExpectPoints(ParsePcd(mixed, "f"), {{1, 0.1, 7}, {2, 5.6e6, -8}});
}

TEST(Pcd, IsRefusedWhereCompressedDataAreNotWhatTheySay) {
  const std::string header = PcdHeader("2", "binary_compressed"), run = "\x17" + std::string(24, 'x');
  ExpectRefused(ParsePcd, header, "byte 120: the file ends");
  ExpectRefused(ParsePcd, header + Bytes<std::uint32_t>({26, 24}) + run, "the file ends within the compressed data");
  ExpectRefused(ParsePcd, header + Bytes<std::uint32_t>({25, 25}) + run,
                "byte 124: not as many bytes as the header says");
  ExpectRefused(ParsePcd, header + Bytes<std::uint32_t>({4000000000u, 24}) + run, "the file ends within");
  ExpectRefused(ParsePcd, header + Bytes<std::uint32_t>({24, 24}) + run,
                "byte 129: the compressed data end within a run");
  ExpectRefused(ParsePcd, header + Bytes<std::uint32_t>({2, 24}) + std::string(2, '\0'),
                "give fewer bytes than they say");
  ExpectRefused(ParsePcd, PcdHeader("300000000", "binary_compressed") + Bytes<std::uint32_t>({25, 3600000000u}) + run,
                "give fewer bytes than they say");
}

TEST(Pcd, GivesPackedColours) {
  const std::string head = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F ", tail = "\nWIDTH 1\nHEIGHT 1\nDATA ";
  const std::vector<std::array<std::uint8_t, 3>> expected{{255, 128, 7}};
  const std::string bits = Bytes<std::uint32_t>({0xfeff8007u}), position = Bytes<float>({1, 2, 3});
  for (const char* type : {"F", "U", "I"})
    EXPECT_EQ(ParsePcd(head + type + tail + "binary\n" + position + bits, "f").rgb, expected) << type;
  EXPECT_EQ(ParsePcd(head + "U" + tail + "ascii\n1 2 3 16744455\n", "f").rgb, expected);
  EXPECT_EQ(ParsePcd(head + "I" + tail + "ascii\n1 2 3 -32761\n", "f").rgb, expected);
  EXPECT_EQ(ParsePcd(head + "F" + tail + "ascii\n1 2 3 2.346398e-38\n", "f").rgb[0][0], 255);  // PCL's own digits
  EXPECT_EQ(ParsePcd(head + "F" + tail + "ascii\n1 2 3 nan\n", "f").rgb[0][0], 0);
}

TEST(Pcd, NamesEveryFaultAtOnce) {
  ExpectRefused(ParsePcd, PcdHeader("4", "ascii") + "1 2 x\n1 2 3\n1 2\n",
                "f:11: no number, got 'x'\nf:13: another number of values than fields; expected 3, got 2\n"
                "f:13: the file");
  ExpectRefused(ParsePcd, "A\nFIELDS x y z\nFIELDS x\nDATA ascii\n", "got 'A'\nf:3: FIELDS is there twice");
}

TEST(Pcd, IsRefusedWithLineOrByte) {
  const std::string rows = "1 2 3\n4 5 6\n";
  ExpectRefused(ParsePcd, "", "does not end");
  ExpectRefused(ParsePcd, "ply\n", "f:1: not a line of a PCD header");
  ExpectRefused(ParsePcd, PcdHeader("2", "binary_packed"), "f:10: these data are not read");
  ExpectRefused(ParsePcd, PcdHeader("3", "ascii") + rows, "the file ends early; expected 3 points, got 2");
  ExpectRefused(ParsePcd, PcdHeader("1", "ascii") + rows, "f:12: more points");
  ExpectRefused(ParsePcd, PcdHeader("2", "ascii") + "1 2 3\n4 5\n", "f:12: another number");
  ExpectRefused(ParsePcd, PcdHeader("2", "ascii") + "1 2 3\n4 5 x\n", "f:12: no number");
  ExpectRefused(ParsePcd, PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, 4, 5}), "byte 109: not as many bytes");
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

// Headers and columns as other tools write them.
TEST(Csv, IsReadAsOtherToolsWriteIt) {
  const std::vector<Eigen::Vector3d> points{{1, 2, 3}, {-4, 0.5, 6}};
  for (const char* text : {"//X Y Z\n1 2 3\n-4 0.5 6\n",                                         // CloudCompare
                           "//X Y Z R G B Intensity\n2\n1 2 3 9 9 9 0.1\n-4 0.5 6 9 9 9 nan\n",  // with a count
                           "//Z;Y;X\n3;2;1;\n6;0.5;-4;\n",                                       //
                           "# remark\n# z y x\n3 2 1\n6 0.5 -4\n",                               // numpy.savetxt
                           "# x y z in the map's frame\n1 2 3\n-4 0.5 6\n",    // a remark, not a header
                           "x,y,z,class\n1,2,3,wall\n-4,0.5,6,\n",             // labels, empty cells
                           "class,x,y,z\n\"wall, north\",1,2,3\n,-4,0.5,6\n",  //
                           "x,y,z,\n1,2,3,\n-4,0.5,6,\n",                      // a comma at the end
                           "x,y,z,\n1,2,3\n-4,0.5,6\n",                        //
                           "x,y,z\n1,2,3,\n-4,0.5,6,,\n",                      //
                           "1,2,3,\n-4,0.5,6,\n",                              //
                           ",x,y,z\n0,1,2,3\n1,-4,0.5,6\n",                    // pandas with its index
                           "2\r\n1 2 3 -5 0 0 0\r\n-4 0.5 6 -7 9 9 9\r\n",     // .pts
                           "1\n1 2 3\n1\n-4 0.5 6\n",                          // two scans in one .pts
                           "\xEF\xBB\xBF"
                           "2\nx\ty\tz\tlabel\n1\t2\t3\ta wall\n-4\t0.5\t6\t\n",         //
                           "\"Points:0\",\"Points:1\",\"Points:2\"\n1,2,3\n-4,0.5,6\n",  // ParaView
                           "Easting,Northing,Elevation\n1,2,3\n-4,0.5,6\n",              //
                           "X [m], Y [m], Z [m]\n\"1\", \"2\", \"3\"\n-4, 0.5, 6\n",     //
                           "\tx\ty\tz\n\t1\t2\t3\n\t-4\t0.5\t6\n",                       //
                           "\t1\t2\t3\n\t-4\t0.5\t6\t\n",                                // indented
                           "% matlab\n1,\t2,\t3\n-4,\t0.5,\t6\n"}) {
    const CloudFile file = ParseCsv(text, "f");
    ExpectPoints(file, points);
    EXPECT_TRUE(file.warnings.empty() && file.left_out == 0) << text;
  }
  for (const char* text :
       {"x;y;z\n1,0;2;3\n-4;0,5;6\n", "1,0 2,0 3,0\n-4 0,5 6\n", "1\t2\t3,0\twall, a\n-4\t0,5\t6\t\n"}) {
    const CloudFile file = ParseCsv(text, "f");
    ExpectPoints(file, points);
    EXPECT_EQ(Warning(file), "f: commas in its numbers are taken for decimal points");
  }
  using Rgb = std::vector<std::array<std::uint8_t, 3>>;
  EXPECT_EQ(ParseCsv("//X Y Z R G B\n1 2 3 204 102 51\n", "f").rgb, (Rgb{{204, 102, 51}}));
  EXPECT_EQ(ParseCsv("x,y,z,red,green,blue\n1,2,3,0.8,0.4,0.2\n1,2,3,1,,0\n", "f").rgb,
            (Rgb{{204, 102, 51}, {255, 0, 0}}));
  EXPECT_EQ(ParseCsv("x,y,z,r,g,b\n1,2,3,1,0,1\n", "f").rgb, (Rgb{{1, 0, 1}}));
}

TEST(Csv, NamesEveryFaultAtOnce) {
  ExpectRefused(ParseCsv, "3\nx,y,z\n1,2,a\n1,2\n1,b,c\n",
                "f:3: no number, got 'a'\nf:4: another number of columns than before; expected 3, got 2\n"
                "f:5: no number");
  std::string many = "x,y,z\n";
  for (int i = 0; i < 1000; ++i) many += "1,2,?\n";
  ExpectRefused(ParseCsv, many, "f:13: no number, got '?'\nf: and 988 more");
}

TEST(Csv, IsRefusedWithItsLine) {
  ExpectRefused(ParseCsv, "", "no points");
  ExpectRefused(ParseCsv, "\n# nothing\n", "no points");
  ExpectRefused(ParseCsv, "a,b,c\n1,2,3\n", "f:1: no coordinates");
  ExpectRefused(ParseCsv, "1,2\n3,4\n", "f:1: no coordinates");
  ExpectRefused(ParseCsv, "1,2,3\n4,5\n", "f:2: another number of columns");
  ExpectRefused(ParseCsv, "1,2,3\n4,5,six\n", "f:2: no number, got 'six'");
  ExpectRefused(ParseCsv, "2\n1,2,3\n", "f:2: the file ends early; expected 2 points, got 1");
  ExpectRefused(ParseCsv, "1\n1,2,3\n4,5,6\n", "f:3: more points than the file says; expected 1 points, got 2");
  ExpectRefused(ParseCsv, "2\n3\n", "f:2: no coordinates");
  ExpectRefused(ParseCsv, "wall 1 2 3\n", "f:1: no coordinates; expected columns x, y, z, got 'wall' and 3 more");
  ExpectRefused(ParseCsv, "1,5,2,5,3,5\n1,5;2;3\n", "f:2: another number of columns");
  ExpectRefused(ParseCsv, "x,y,z\n1,2,3,4\n1,2\n",
                "f:2: another number of columns than before; expected 3, got 4\nf:3:");
  ExpectRefused(ParseCsv, "1,2,3\n4,5,1e999\n", "f:2: no number");
  ExpectRefused(ParseCsv, "x,y,z,X\n1,2,3,4\n", "twice");
  ExpectRefused(ParseCsv, std::string("\x1b[2J\x00,2,3", 10), "f:1");
}

TEST(CloudFile, LeavesOutAndCountsPointsThatAreNone) {
  const CloudFile file =
      ParseCsv("x,y,z,sigma_m\n1,2,3,1\nnan,2,3,1\n1,inf,3,1\n1,2,-1e10,1\n1,2,3,0\n1,2,3,nan\n", "f");
  ExpectPoints(file, {{1, 2, 3}});
  EXPECT_EQ(file.left_out, 5u);
  const CloudFile cells = ParseCsv("x,y,z\n1,2,3\n,2,3\n1,,3\n1,2,\n1,NULL,3\n1,2,N/A\n,,\n", "f");
  ExpectPoints(cells, {{1, 2, 3}});
  EXPECT_EQ(cells.left_out, 6u);
  EXPECT_EQ(ParseCsv(",2,3\n1,2,\n1,2,3\n", "f").left_out, 2u);
  EXPECT_EQ(ParseCsv("x\ty\tz\n\t2\t3\n1\t2\t\n1\t2\t3\n", "f").left_out, 2u);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ParsePcd(PcdHeader("2", "binary") + Bytes<float>({1, 2, 3, nan, nan, nan}), "f").left_out, 1u);
  EXPECT_EQ(ParsePly(PlyHeader("ascii", "element vertex 0\n" + kXyz), "f").cloud.size(), 0u);
}

TEST(CloudFile, IsChosenByItsEnding) {
  const TemporaryFolder folder;
  for (const char* name : {"a.CSV", "a.txt", "a.xyz", "a.asc", "a.pts"}) {
    std::ofstream(folder.path() / name) << "1,2,3\n";
    ExpectPoints(ReadCloud(folder.path() / name), {{1, 2, 3}});
  }
  std::filesystem::create_directory(folder.path() / "d.ply");
  std::ofstream(folder.path() / "a.stl") << "solid\n";
  for (const char* name : {"none.ply", "d.ply", "a.stl", "", "a"})
    EXPECT_THROW(ReadCloud(folder.path() / name), InputError) << name;
}

// Ten thousand mutations of valid files: each is read, or rejected in one sentence. The sanitizers watch.
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
      {ParsePcd,
       PcdHeader("2", "binary_compressed") + Bytes<std::uint32_t>({7, 24}) + std::string("\x00z\xe0\x0e\x00\x00z", 7)},
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
      EXPECT_LE(file.cloud.size() + file.left_out, 88 * bytes.size());
      EXPECT_TRUE(file.cloud.sigma_m.empty() || file.cloud.sigma_m.size() == file.cloud.size());
      EXPECT_TRUE(file.rgb.empty() || file.rgb.size() == file.cloud.size());
      ++read;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with("f")) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 3000);
}

}  // namespace
}  // namespace merlin
