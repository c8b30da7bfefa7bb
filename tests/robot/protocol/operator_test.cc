#include "robot/protocol/operator.h"

#include <gtest/gtest.h>

namespace merlin::operator_link {
namespace {

TEST(OperatorLink, DecodesEveryMessageThatItEncodes) {
  Decoder decoder;
  std::uint8_t sequence = 250;
  for (int command = 0; command < 256; ++command)
    for (int switches = 0; switches < 8; ++switches) {
      const Message message{.command = static_cast<std::uint8_t>(command),
                            .held = (switches & 1) != 0,
                            .override_stop = (switches & 2) != 0,
                            .autonomy = (switches & 4) != 0};
      EXPECT_EQ(decoder.Feed(Encode(message, sequence++)), message);
    }
  EXPECT_EQ(decoder.counters().lost, 0u);
}

TEST(OperatorLink, FitsThePacketsOfTheRadioManyTimes) { EXPECT_LE(Encode({}, 0).size(), 10u); }

TEST(OperatorLink, HandsOutTheNewestOfSeveralAndNothingForNothing) {
  Decoder decoder;
  EXPECT_FALSE(decoder.Feed({}));
  Bytes both = Encode({.command = 1}, 0);
  const Bytes second = Encode({.command = 2}, 1);
  both.insert(both.end(), second.begin(), second.end());
  EXPECT_EQ(decoder.Feed(both)->command, 2);
}

TEST(OperatorLink, TakesNoDamagedFrameAndNoOtherType) {
  const Bytes good = Encode({.command = 0x71, .held = true}, 3);
  for (std::size_t i = 1; i + 1 < good.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      Decoder decoder;
      Bytes bad = good;
      bad[i] = static_cast<std::uint8_t>(bad[i] ^ (1 << bit));
      EXPECT_FALSE(decoder.Feed(bad)) << i << " " << bit;
      EXPECT_TRUE(decoder.Feed(good));
    }
  Decoder decoder;
  EXPECT_FALSE(decoder.Feed(EncodeFrame({.type = 0x02, .sequence = 0, .payload = {1, 1}})));
  EXPECT_FALSE(decoder.Feed(EncodeFrame({.type = 0x10, .sequence = 1, .payload = {1}})));
  EXPECT_FALSE(decoder.Feed(EncodeFrame({.type = 0x10, .sequence = 2, .payload = {1, 1, 1}})));
  EXPECT_EQ(decoder.counters().bad_payload, 3u);
}

}  // namespace
}  // namespace merlin::operator_link
