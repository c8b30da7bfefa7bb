// The radio's packets and latencies against the data sheet's numbers.
#include "robot/emulated/radio.h"

#include <gtest/gtest.h>

#include "robot/emulated/serial_line.h"

namespace merlin {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

// When the last of n bytes has come out at the other end.
double Latency_s(int baud, std::size_t n) {
  Radio radio({.baud = baud}, 1);
  radio.Put(Side::kHost, Time(0), Bytes(n, 0x55));
  std::size_t came = 0;
  for (Time now{0}; now < std::chrono::seconds(1); now += microseconds(10)) {
    came += radio.Take(Side::kDevice, now).size();
    if (came == n) return Seconds(now);
  }
  return HUGE_VAL;
}

TEST(Radio, TakesAsLongAsTheDataSheetSays) {
  EXPECT_NEAR(Latency_s(9600, 1), 0.009, 0.0005);
  EXPECT_NEAR(Latency_s(9600, 96), 0.215, 0.0005);
  EXPECT_NEAR(Latency_s(115200, 8), 0.008, 0.0005);
  // 10 n / baud + silence + 5 ms + 8 (n + 6) / 100k + 10 n / baud
  EXPECT_NEAR(Latency_s(9600, 1), 10.0 / 9600 + 15.0 / 9600 + 0.005 + 56e-5 + 10.0 / 9600, 2e-5);
  EXPECT_NEAR(Latency_s(57600, 20), 200.0 / 57600 + 0.0005 + 0.005 + 208e-5 + 200.0 / 57600, 2e-5);
}

TEST(Radio, CutsPacketsAtSilenceAndKeepsOrder) {
  Radio radio({.baud = 9600}, 1);
  radio.Put(Side::kHost, Time(0), Bytes{1, 2, 3});
  EXPECT_TRUE(radio.Take(Side::kDevice, milliseconds(9)).empty());
  radio.Put(Side::kHost, milliseconds(30), Bytes{4});
  EXPECT_EQ(radio.Take(Side::kDevice, milliseconds(100)), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(radio.lost_bytes(), 0u);
}

TEST(Radio, LosesBytesThatArriveWhileItSends) {
  Radio radio({.baud = 9600}, 1);
  radio.Put(Side::kHost, Time(0), Bytes(10, 1));
  // Packet's end: 10.4 + 1.6 ms; sending until 12 + 5 + 1.28 ms.
  radio.Take(Side::kDevice, milliseconds(12));
  radio.Put(Side::kHost, milliseconds(13), Bytes{2});
  radio.Put(Side::kHost, milliseconds(20), Bytes{3});
  Bytes expected(10, 1);
  expected.push_back(3);
  EXPECT_EQ(radio.Take(Side::kDevice, milliseconds(100)), expected);
  EXPECT_EQ(radio.lost_bytes(), 1u);
}

TEST(Radio, LosesWhatDoesNotFitThePacket) {
  Radio radio({.baud = 57600}, 1);
  radio.Put(Side::kHost, Time(0), Bytes(100, 1));
  EXPECT_EQ(radio.Take(Side::kDevice, milliseconds(100)).size(), 96u);
  EXPECT_EQ(radio.lost_bytes(), 4u);
}

TEST(Radio, LetsOneWaitWhileTheOtherSends) {
  Radio radio({.baud = 9600}, 1);
  radio.Put(Side::kHost, Time(0), Bytes{1});
  radio.Put(Side::kDevice, Time(0), Bytes{2});
  EXPECT_EQ(radio.Take(Side::kDevice, milliseconds(50)), (Bytes{1}));
  EXPECT_EQ(radio.Take(Side::kHost, milliseconds(50)), (Bytes{2}));
  Radio again({.baud = 9600}, 1);
  again.Put(Side::kHost, Time(0), Bytes{1});
  again.Put(Side::kDevice, Time(0), Bytes{2});
  EXPECT_TRUE(again.Take(Side::kHost, milliseconds(14)).empty());  // 9.2 ms, and 5.6 ms of the other's
  EXPECT_EQ(again.Take(Side::kHost, milliseconds(15)), (Bytes{2}));
}

TEST(Radio, LosesItsShareOfPacketsTheSameOnesEachTime) {
  const auto run = [](std::uint64_t seed) {
    Radio radio({.baud = 115200, .packet_loss = 0.2}, seed);
    Bytes came;
    for (int i = 0; i < 1000; ++i) {
      radio.Put(Side::kHost, milliseconds(20) * i, Bytes{static_cast<std::uint8_t>(i)});
      for (const std::uint8_t byte : radio.Take(Side::kDevice, milliseconds(20) * i + milliseconds(19)))
        came.push_back(byte);
    }
    EXPECT_EQ(came.size() + radio.lost_packets(), 1000u);
    return came;
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
  EXPECT_NEAR(static_cast<double>(run(1).size()), 800.0, 4.0 * std::sqrt(1000 * 0.2 * 0.8));
}

TEST(SerialLine, TakesTenBitTimesAByteBothWaysAtOnce) {
  SerialLine line(9600);
  line.Put(Side::kHost, Time(0), Bytes{1, 2, 3});
  line.Put(Side::kDevice, Time(0), Bytes{4});
  EXPECT_TRUE(line.Take(Side::kDevice, microseconds(1041)).empty());
  EXPECT_EQ(line.Take(Side::kDevice, microseconds(2084)), (Bytes{1, 2}));
  EXPECT_EQ(line.Take(Side::kHost, microseconds(1042)), (Bytes{4}));
  line.Put(Side::kHost, microseconds(2084), Bytes{5});  // behind the third
  EXPECT_TRUE(line.Take(Side::kDevice, microseconds(3124)).empty());
  EXPECT_EQ(line.Take(Side::kDevice, microseconds(4167)), (Bytes{3, 5}));
}

}  // namespace
}  // namespace merlin
