#include "robot/emulated/depth_wire.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace merlin {
namespace {

using Bytes = std::vector<std::uint8_t>;

WireFrame SmallFrame() {
  return {.columns = 2,
          .rows = 1,
          .stamp_ns = 0x0102030405060708,
          .settings = {1000, 20000000, 0},
          .range_m = {1.0f, 2.0f},
          .amplitude = {0.5f, 0.0f},
          .intensity = {7, 255},
          .flags = {0, 17}};
}

WireHello SmallHello() {
  return {.camera = {.width = 2, .height = 1, .fx_px = 1.0, .fy_px = 1.0, .cx_px = 0.5, .cy_px = 0.0},
          .integration_min_us = 100,
          .integration_max_us = 5000,
          .frequencies_hz = {20000000, 30000000},
          .settings = {1000, 20000000, 0}};
}

Bytes Concatenated(const Bytes& a, const Bytes& b) {
  Bytes both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

WireReading::Kind KindOf(const Bytes& bytes) { return Decode(bytes).kind; }

TEST(DepthWire, WritesTheBytesOfItsDescription) {
  EXPECT_EQ(Encode(WireUpdate{}), (Bytes{'M', 'P', 'M', 'D', 1, 0, 2, 0, 0, 0, 0, 0}));
  // 1000 us = 0x3e8, 20 MHz = 0x01312d00, 30 MHz = 0x01c9c380.
  EXPECT_EQ(Encode(WireSet{{1000, 20000000, 30000000}}),
            (Bytes{'M', 'P', 'M', 'D', 1, 0, 4, 0, 12, 0, 0, 0, 0xe8, 3, 0, 0, 0, 0x2d, 0x31, 1, 0x80, 0xc3, 0xc9, 1}));
  EXPECT_EQ(Encode(WireRefused{"no"}), (Bytes{'M', 'P', 'M', 'D', 1, 0, 6, 0, 2, 0, 0, 0, 'n', 'o'}));
  // Range 1 = 0x3f800000, 2 = 0x40000000, amplitude 0.5 = 0x3f000000.
  EXPECT_EQ(Encode(SmallFrame()),
            (Bytes{'M',  'P',  'M', 'D', 1, 0,    3, 0, 44, 0,    0,    0,    2, 0, 1, 0,   8, 7, 6,
                   5,    4,    3,   2,   1, 0xe8, 3, 0, 0,  0,    0x2d, 0x31, 1, 0, 0, 0,   0, 0, 0,
                   0x80, 0x3f, 0,   0,   0, 0x40, 0, 0, 0,  0x3f, 0,    0,    0, 0, 7, 255, 0, 17}));
}

TEST(DepthWire, ReadsBackWhatItWrote) {
  const auto frame = As<WireFrame>(Decode(Encode(SmallFrame())).message);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->range_m, SmallFrame().range_m);
  EXPECT_EQ(frame->flags, SmallFrame().flags);
  EXPECT_EQ(frame->settings, SmallFrame().settings);
  EXPECT_EQ(frame->stamp_ns, SmallFrame().stamp_ns);
  const auto hello = As<WireHello>(Decode(Encode(SmallHello())).message);
  ASSERT_TRUE(hello.has_value());
  EXPECT_EQ(hello->camera.cx_px, 0.5);
  EXPECT_EQ(hello->frequencies_hz, SmallHello().frequencies_hz);
  EXPECT_EQ(hello->integration_max_us, 5000u);
}

TEST(DepthWire, KeepsTheBitsOfEveryRange) {
  WireFrame frame = SmallFrame();
  frame.range_m = {std::nextafter(7.4948f, 8.0f), std::numeric_limits<float>::denorm_min()};
  frame.amplitude = {std::numeric_limits<float>::quiet_NaN(), -0.0f};
  const auto read = As<WireFrame>(Decode(Encode(frame)).message);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(std::memcmp(read->range_m.data(), frame.range_m.data(), 8), 0);
  EXPECT_EQ(std::memcmp(read->amplitude.data(), frame.amplitude.data(), 8), 0);
}

TEST(DepthWire, WaitsForTheRestOfAMessage) {
  const Bytes whole = Encode(SmallFrame());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(KindOf(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))),
              WireReading::Kind::kPartial);
  EXPECT_EQ(Decode(Concatenated(whole, {1, 2, 3})).bytes, whole.size());
}

TEST(DepthWire, ReportsBytesThatAreNoMessageAsGarbage) {
  const auto with = [](std::size_t place, std::uint8_t byte) {
    Bytes bytes = Encode(SmallFrame());
    bytes[place] = byte;
    return KindOf(bytes);
  };
  EXPECT_EQ(with(0, 'X'), WireReading::Kind::kGarbage);
  EXPECT_EQ(with(4, 2), WireReading::Kind::kGarbage);  // another version
  EXPECT_EQ(with(6, 0), WireReading::Kind::kGarbage);  // no such kind
  EXPECT_EQ(with(6, 7), WireReading::Kind::kGarbage);
  EXPECT_EQ(with(11, 0xff), WireReading::Kind::kGarbage);  // longer than anything
  EXPECT_EQ(with(12, 1), WireReading::Kind::kGarbage);     // a size that the images do not have
  EXPECT_EQ(with(14, 0), WireReading::Kind::kGarbage);     // no rows
  EXPECT_EQ(KindOf({'G'}), WireReading::Kind::kGarbage);   // at the first byte
  WireHello hello = SmallHello();
  hello.camera.fx_px = std::nan("");
  EXPECT_EQ(KindOf(Encode(hello)), WireReading::Kind::kGarbage);
  hello = SmallHello();
  hello.frequencies_hz.clear();
  EXPECT_EQ(KindOf(Encode(hello)), WireReading::Kind::kGarbage);
}

TEST(DepthWire, CutsLongTexts) {
  const auto refused = As<WireRefused>(Decode(Encode(WireRefused{std::string(1000, 'x')})).message);
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->why.size(), 256u);
}

}  // namespace
}  // namespace merlin
