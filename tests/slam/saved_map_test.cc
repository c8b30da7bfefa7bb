#include "slam/saved_map.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "robot/base/sha256.h"
#include "tests/support/temporary_folder.h"

namespace merlin {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A view of a wall with a hole in it, all kinds of rays.
Observation SomeView() {
  Observation seen;
  seen.camera_base = {0.3f, 0.0f, 0.35f};
  for (float y = -0.4f; y < 0.4f; y += 0.1f) seen.points_base.push_back({.position = {2.0f, y, 0.3f}});
  seen.free_base = {{4.0f, 0.2f, 0.6f}};
  seen.unknown_base = {{0.9f, 0.1f, 0.42f}};
  return seen;
}

// Two key frames, of two runs, with one loop; numbers that a text would not keep.
SavedMap SomeMap() {
  SavedMap map;
  map.heading_turn_rad = 1.0 / 3.0;
  Keyframe first, second;
  first.stamp = Time(-123456789);
  first.path_m = -12.1;
  first.camera_base = {0.3f, 0.0f, 0.35f};
  first.first_of_run = true;
  first.points_base = {{.position = {1.1f, -0.0f, 1e-42f}, .sigma_m = 0.005f, .bgr = {1, 2, 255}, .has_color = true},
                       {.position = {kNan, 2.0f, HUGE_VALF}}};
  first.yaw_sigma_rad = HUGE_VAL;
  first.views = {{first.stamp, Pose::Identity(), ClearView(SomeView())}, {}};
  second.stamp = Time(5);
  second.T_map_base = FromXyYaw(0.1, 1e-17, 3.0);
  second.path_m = 0.1;
  second.T_previous_base = Exp((Vector6d() << 1, 2, 3, 0.1, 0.2, 0.3).finished());
  second.yaw_rad = -0.7;
  second.in_local_map_m = 0.05;
  map.keyframes = {first, second};
  map.loops = {
      {.from = 1, .to = 0, .T_from_to = FromXyYaw(0.5, 0.25, -1.0), .information = 3.0 * Matrix6d::Identity()}};
  return map;
}

// What reading these bytes says; empty: nothing to complain about.
std::string Complaint(const std::string& bytes) {
  try {
    ParseSavedMap(bytes, "a/map.slam");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The same content with a header that fits it.
std::string Sealed(const std::string& content) {
  std::string bytes = ToBytes(SomeMap()).substr(0, 12);
  const auto size = std::bit_cast<std::array<char, 8>>(std::uint64_t{content.size()});
  Sha256 hash;
  hash.Add(content);
  return bytes.append(size.data(), size.size()) + hash.Hex() + content;
}
std::string ContentIn(const std::string& bytes) { return bytes.substr(84); }

template <class Value>
bool SameBits(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(SavedMap, ComesBackBitByBit) {
  const SavedMap map = SomeMap(), again = ParseSavedMap(ToBytes(map), "a");
  EXPECT_EQ(ToBytes(again), ToBytes(map));
  ASSERT_EQ(again.keyframes.size(), 2u);
  EXPECT_EQ(*again.heading_turn_rad, 1.0 / 3.0);
  for (std::size_t i = 0; i < 2; ++i) {
    const Keyframe &a = map.keyframes[i], &b = again.keyframes[i];
    EXPECT_EQ(a.stamp, b.stamp);
    EXPECT_EQ(a.T_map_base.matrix(), b.T_map_base.matrix());
    EXPECT_EQ(a.T_previous_base.matrix(), b.T_previous_base.matrix());
    EXPECT_EQ(a.first_of_run, b.first_of_run);
    EXPECT_EQ(a.path_m, b.path_m);
    EXPECT_EQ(a.in_local_map_m, b.in_local_map_m);
    EXPECT_EQ(a.yaw_rad, b.yaw_rad);
    EXPECT_EQ(a.yaw_sigma_rad, b.yaw_sigma_rad);
    EXPECT_EQ(a.camera_base, b.camera_base);
    ASSERT_EQ(a.points_base.size(), b.points_base.size());
    for (std::size_t k = 0; k < a.points_base.size(); ++k) {
      EXPECT_TRUE(SameBits(a.points_base[k].position, b.points_base[k].position));
      EXPECT_TRUE(SameBits(a.points_base[k].sigma_m, b.points_base[k].sigma_m));
      EXPECT_EQ(a.points_base[k].bgr, b.points_base[k].bgr);
      EXPECT_EQ(a.points_base[k].has_color, b.points_base[k].has_color);
    }
    ASSERT_EQ(a.views.size(), b.views.size());
  }
  const ClearView &seen = map.keyframes[0].views[0].view, &read = again.keyframes[0].views[0].view;
  ASSERT_GT(seen.reach_m(), 3.0f);
  EXPECT_EQ(seen.reach_m(), read.reach_m());
  for (float y = -1.0f; y < 1.0f; y += 0.03f) {
    EXPECT_EQ(seen.Along({1.0f, y, 0.0f}).length_m, read.Along({1.0f, y, 0.0f}).length_m);
    EXPECT_EQ(seen.Along({1.0f, y, 0.0f}).dark, read.Along({1.0f, y, 0.0f}).dark);
  }
  ASSERT_EQ(again.loops.size(), 1u);
  EXPECT_EQ(again.loops[0].from, 1u);
  EXPECT_EQ(again.loops[0].to, 0u);
  EXPECT_EQ(again.loops[0].T_from_to.matrix(), map.loops[0].T_from_to.matrix());
  EXPECT_EQ(again.loops[0].information, map.loops[0].information);
}

TEST(SavedMap, IsRefusedAtEveryLengthButItsOwn) {
  const std::string bytes = ToBytes(SomeMap());
  ASSERT_EQ(Complaint(bytes), "");
  for (std::size_t length = 0; length < bytes.size(); ++length)
    ASSERT_NE(Complaint(bytes.substr(0, length)), "") << length;
  EXPECT_NE(Complaint(bytes + '\0'), "");
}

TEST(SavedMap, IsRefusedWithAnyByteChanged) {
  std::string bytes = ToBytes(SomeMap());
  for (char& byte : bytes)
    for (const char flip : {'\x01', '\x80', '\xff'}) {
      byte = static_cast<char>(byte ^ flip);
      ASSERT_NE(Complaint(bytes), "") << "byte " << &byte - bytes.data();
      byte = static_cast<char>(byte ^ flip);
    }
}

TEST(SavedMap, SaysWhatIsWrongInOneSentence) {
  const std::string bytes = ToBytes(SomeMap());
  EXPECT_EQ(Complaint(""), "a/map.slam: is not a map; expected a map of an earlier run (map.slam)");
  std::string later = bytes;
  later[8] = 2;
  EXPECT_EQ(Complaint(later), "a/map.slam: a map of another version of the program; expected version 1, got version 2");
  EXPECT_EQ(Complaint(bytes.substr(0, bytes.size() - 1)),
            "a/map.slam: a damaged map; expected " + std::to_string(bytes.size() - 84) +
                " bytes after the header, got " + std::to_string(bytes.size() - 85));
  std::string changed = bytes;
  changed.back() ^= 1;
  EXPECT_EQ(Complaint(changed), "a/map.slam: a damaged map: its bytes do not give the checksum in its header");
  EXPECT_EQ(Complaint(ToBytes({})), "a/map.slam: a map without key frames: it shows no place");
  try {
    ReadSavedMap("/no/such/map.slam");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "/no/such/map.slam: cannot be read; expected a map of an earlier run (map.slam)");
  }
}

// With a checksum that is right: what is taken must be a map that can be written again, and what lies about a count must
// not cost memory.
TEST(SavedMap, TakesOnlyWholeMapsWhateverTheContentSays) {
  const std::string content = ContentIn(ToBytes(SomeMap()));
  int refused = 0;
  for (std::size_t at = 0; at < content.size(); ++at)
    for (const char value : {'\x00', '\x01', '\x7f', '\xff'}) {
      std::string forged = content;
      forged[at] = value;
      const std::string bytes = Sealed(forged);
      try {
        EXPECT_EQ(ToBytes(ParseSavedMap(bytes, "a")), bytes) << at;
      } catch (const InputError&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 100);
  for (std::size_t length = 0; length < content.size(); ++length)
    ASSERT_NE(Complaint(Sealed(content.substr(0, length))), "") << length;
}

TEST(SavedMap, RefusesWhatTheProgramTakesForGranted) {
  const auto refuses = [](auto spoil) {
    SavedMap map = SomeMap();
    spoil(map);
    return Complaint(ToBytes(map)) ==
           "a/map.slam: a damaged map: the checksum is right, but the content is not that of a map";
  };
  EXPECT_FALSE(refuses([](SavedMap&) {}));
  EXPECT_TRUE(refuses([](SavedMap& map) { map.loops[0].to = 2; }));
  EXPECT_TRUE(refuses([](SavedMap& map) { map.loops[0].to = 1; })) << "to itself";
  EXPECT_TRUE(refuses([](SavedMap& map) { map.loops[0].information(2, 3) = NAN; }));
  EXPECT_TRUE(refuses([](SavedMap& map) { map.keyframes[1].path_m = -20.0; })) << "not in order";
  EXPECT_TRUE(refuses([](SavedMap& map) { map.keyframes[0].T_map_base.linear() *= 2.0; })) << "no rotation";
  EXPECT_TRUE(refuses([](SavedMap& map) { map.keyframes[0].T_map_base.translation().x() = HUGE_VAL; }));
  EXPECT_TRUE(refuses([](SavedMap& map) { map.keyframes[0].yaw_sigma_rad = NAN; }));
  EXPECT_TRUE(refuses([](SavedMap& map) { map.heading_turn_rad = HUGE_VAL; }));
}

TEST(SavedMap, IsReadFromAFile) {
  const TemporaryFolder folder;
  WriteFile(folder.path() / "map.slam", ToBytes(SomeMap()));
  EXPECT_EQ(ToBytes(ReadSavedMap(folder.path() / "map.slam")), ToBytes(SomeMap()));
}

}  // namespace
}  // namespace merlin
