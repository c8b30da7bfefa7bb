// The 3DM's bytes and angles by hand: a quarter turn is 16384 counts.
#include "robot/protocol/compass_3dm.h"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

namespace merlin::compass_3dm {
namespace {

using std::chrono::milliseconds;
constexpr double kDeg = std::numbers::pi / 180.0;

TEST(Compass3dm, ReadsBigEndianWords) {
  const auto counts = DecodeReply(Bytes{0x44, 0x12, 0x34, 0xFF, 0xFE, 0x80, 0x00}, false);
  ASSERT_TRUE(counts);
  EXPECT_EQ(*counts, (Counts{0x1234, 0xFFFE, 0x8000}));
}

TEST(Compass3dm, RejectsInvalidReplies) {
  EXPECT_FALSE(DecodeReply({}, false));
  EXPECT_FALSE(DecodeReply(Bytes{0x44, 0, 0, 0, 0, 0}, false));
  EXPECT_FALSE(DecodeReply(Bytes{0x44, 0, 0, 0, 0, 0, 0, 0}, false));
  EXPECT_FALSE(DecodeReply(Bytes{0x45, 0, 0, 0, 0, 0, 0}, false));
  EXPECT_TRUE(DecodeReply(Bytes{0x44, 1, 2, 3, 4, 5, 6, 0x59}, true));  // 0x44 + 21
  EXPECT_FALSE(DecodeReply(Bytes{0x44, 1, 2, 3, 4, 5, 6, 0x58}, true));
  EXPECT_FALSE(DecodeReply(Bytes{0x44, 1, 2, 3, 4, 5, 6}, true));
}

// Aircraft axes have y to the right and z down: pitch and heading turn the other way round than in our body's frame.
TEST(Compass3dm, DecodesExactlyInAllFourQuadrants) {
  const double quarters_deg[] = {0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0};
  const double signed_deg[] = {0.0, 45.0, 90.0, 135.0, -180.0, -135.0, -90.0, -45.0};
  for (unsigned i = 0; i < 8; ++i) {
    const auto word = static_cast<std::uint16_t>(i * 8192);
    const Attitude attitude = ToAttitude({word, word, word});
    EXPECT_DOUBLE_EQ(attitude.roll_rad, signed_deg[i] * kDeg);
    EXPECT_DOUBLE_EQ(attitude.pitch_rad, -signed_deg[i] * kDeg);
    EXPECT_DOUBLE_EQ(attitude.heading_rad, quarters_deg[i] * kDeg);
  }
  EXPECT_DOUBLE_EQ(ToAttitude({1, 1, 1}).roll_rad, 360.0 / 65536.0 * kDeg);
  EXPECT_DOUBLE_EQ(ToAttitude({65535, 65535, 65535}).roll_rad, -360.0 / 65536.0 * kDeg);
  EXPECT_DOUBLE_EQ(ToAttitude({65535, 65535, 65535}).heading_rad, 65535.0 * 360.0 / 65536.0 * kDeg);
}

TEST(Compass3dm, CountsComeBackForEveryWord) {
  for (unsigned word = 0; word < 65536; ++word) {
    const Counts counts{static_cast<std::uint16_t>(word), static_cast<std::uint16_t>(word),
                        static_cast<std::uint16_t>(word)};
    ASSERT_EQ(ToCounts(ToAttitude(counts)), counts);
  }
}

// merlin.md: roll >= 49151 -> 0.0055 x - 361, pitch >= 32768 -> 360 - 0.0055 x, yaw 360 - 0.0055 x.
TEST(Compass3dm, TheThesisArithmeticIsAsPrinted) {
  const Attitude low = ToAttitude({10000, 10000, 10000}, Arithmetic::kThesis);
  EXPECT_NEAR(low.roll_rad, 55.0 * kDeg, 1e-12);
  EXPECT_NEAR(low.pitch_rad, -55.0 * kDeg, 1e-12);
  EXPECT_NEAR(low.heading_rad, 55.0 * kDeg, 1e-12);  // yaw 305 deg
  const Attitude high = ToAttitude({60000, 60000, 60000}, Arithmetic::kThesis);
  EXPECT_NEAR(high.roll_rad, (330.0 - 361.0) * kDeg, 1e-12);
  EXPECT_NEAR(high.pitch_rad, 30.0 * kDeg, 1e-12);
  EXPECT_NEAR(ToAttitude({49150, 0, 0}, Arithmetic::kThesis).roll_rad, 270.325 * kDeg, 1e-12);
  EXPECT_NEAR(ToAttitude({49151, 32767, 0}, Arithmetic::kThesis).roll_rad, (270.3305 - 361.0) * kDeg, 1e-12);
  EXPECT_NEAR(ToAttitude({0, 32767, 0}, Arithmetic::kThesis).pitch_rad, -180.2185 * kDeg, 1e-12);
  EXPECT_NEAR(ToAttitude({0, 32768, 0}, Arithmetic::kThesis).pitch_rad, 179.776 * kDeg, 1e-12);
}

TEST(Compass3dm, TheThesisArithmeticIsOffByLessThanADegree) {
  double worst_deg = 0.0;
  for (unsigned word = 49151; word < 65536; ++word) {
    const Counts counts{static_cast<std::uint16_t>(word), 0, 0};
    worst_deg = std::max(
        worst_deg, std::abs(ToAttitude(counts).roll_rad - ToAttitude(counts, Arithmetic::kThesis).roll_rad) / kDeg);
  }
  EXPECT_NEAR(worst_deg, 0.67, 0.01);
}

constexpr Counts kCounts{100, 200, 300};

// One poll from its start on; returns when the reading was there.
void Poll(Poller& poller, Time start, BytesView reply) {
  EXPECT_EQ(poller.next(), start);
  EXPECT_EQ(poller.Send(start), (Bytes{0x74}));
  EXPECT_TRUE(poller.Send(start + milliseconds(34)).empty());
  EXPECT_EQ(poller.next(), start + milliseconds(35));
  EXPECT_EQ(poller.Send(start + milliseconds(35)), (Bytes{0xC0}));
  poller.Receive(start + milliseconds(50), reply);
}

TEST(Compass3dmPoller, AsksWaitsAndReads) {
  Poller poller({});
  Poll(poller, Time(0), EncodeReply(kCounts, false));
  EXPECT_FALSE(poller.Take());  // the wait is not over
  EXPECT_EQ(poller.next(), milliseconds(70));
  EXPECT_TRUE(poller.Send(milliseconds(70)).empty());
  const auto reading = poller.Take();
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->counts, kCounts);
  EXPECT_EQ(reading->asked, milliseconds(35));
  EXPECT_FALSE(poller.Take());
  Poll(poller, milliseconds(80), EncodeReply(kCounts, false));  // 12.5 Hz
}

// Whatever it was at: until it has asked, and that reply is judged. The reading, if it was good.
std::optional<Poller::Reading> NextPoll(Poller& poller, BytesView reply) {
  while (poller.Send(poller.next()) != Bytes{0xC0}) continue;
  poller.Receive(poller.next(), reply);
  poller.Send(poller.next());
  return poller.Take();
}

TEST(Compass3dmPoller, TakesALateReplyAndGivesUpOnNone) {
  Poller late({});
  Poll(late, Time(0), {});
  EXPECT_EQ(late.next(), milliseconds(100));  // 70 ms and its patience
  late.Receive(milliseconds(90), EncodeReply(kCounts, false));
  EXPECT_EQ(late.Send(milliseconds(90)), (Bytes{0x74}));  // the next poll is due already
  EXPECT_TRUE(late.Take());
  Poller silent({});
  EXPECT_FALSE(NextPoll(silent, {}));
  EXPECT_EQ(silent.failed_polls(), 1u);
  EXPECT_TRUE(NextPoll(silent, EncodeReply(kCounts, false)));
}

TEST(Compass3dmPoller, ThrowsAwayAReplyWithGarbageAndReadsTheNext) {
  const Bytes good = EncodeReply(kCounts, false);
  std::vector<Bytes> bad{Bytes(500, 0x44), Bytes(good.begin(), good.end() - 1), Bytes(good.begin() + 1, good.end())};
  for (const std::uint8_t garbage : {0x00, 0x44, 0xFF}) {
    bad.push_back(good), bad.back().insert(bad.back().begin(), garbage);
    bad.push_back(good), bad.back().push_back(garbage);
  }
  Poller poller({});
  std::uint64_t bytes = 0;
  for (const Bytes& reply : bad) {
    EXPECT_FALSE(NextPoll(poller, reply));
    bytes += reply.size();
    EXPECT_EQ(poller.garbage_bytes(), bytes);
    EXPECT_TRUE(NextPoll(poller, good));
  }
  EXPECT_EQ(poller.failed_polls(), bad.size());
}

TEST(Compass3dmPoller, CountsBytesNobodyAskedFor) {
  Poller poller({});
  poller.Receive(Time(0), EncodeReply(kCounts, false));
  poller.Send(Time(0));
  poller.Receive(milliseconds(10), EncodeReply(kCounts, false));
  EXPECT_EQ(poller.garbage_bytes(), 14u);
  EXPECT_FALSE(poller.Take());
}

TEST(Compass3dmPoller, DoesNotHurryAfterAPause) {
  Poller poller({});
  Poll(poller, Time(0), EncodeReply(kCounts, false));
  EXPECT_EQ(poller.Send(std::chrono::seconds(10)), (Bytes{0x74}));
  EXPECT_EQ(poller.next(), std::chrono::seconds(10) + kWait);
}

}  // namespace
}  // namespace merlin::compass_3dm
