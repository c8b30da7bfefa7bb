// The messages against hand-written bytes: laid out by hand, CRCs from Python's binascii.crc_hqx.
#include "robot/protocol/microcontroller.h"

#include <gtest/gtest.h>

#include <limits>

#include "robot/base/error.h"

namespace merlin::microcontroller {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
using std::chrono::milliseconds;

const State kState{.micro_time_ms = 123456,
                   .encoder_counts = -70000,
                   .steering_rad = 0.1234,
                   .current_a = -1.5,
                   .battery_v = 7.2,
                   .expired = true,
                   .last_command = 7,
                   .pan_angle_rad = -1.5708};

template <class Message>
Message Single(const Bytes& wire) {
  Decoder<Message> decoder;
  const auto received = decoder.Feed(wire);
  EXPECT_EQ(received.size(), 1u);
  return received.empty() ? Message{} : received[0].message;
}

Command Through(const Command& command) { return std::get<Command>(Single<ToMicro>(Encode(ToMicro(command), 3))); }

TEST(MicrocontrollerMessages, AreTheBytesWrittenByHand) {
  const std::vector<std::pair<Bytes, Bytes>> encoded_and_by_hand{
      {Encode(ToMicro(Hello{}), 0), {0x00, 0x03, 0x01, 0x01, 0x03, 0xC8, 0x9D, 0x00}},
      // 1000 ms, 250 ms, 500000 um/s, -2000 steps
      {Encode(ToMicro(Command{1000, 0.5, -0.2, milliseconds(250)}), 7),
       {0x00, 0x04, 0x01, 0x02, 0x07, 0x01, 0x03, 0x03, 0xE8, 0x02,
        0xFA, 0x08, 0x07, 0xA1, 0x20, 0xF8, 0x30, 0x0E, 0x6F, 0x00}},
      // expire now
      {Encode(ToMicro(Command{1000, 0.5, kNaN, milliseconds(250)}), 8),
       {0x00, 0x04, 0x01, 0x02, 0x08, 0x01, 0x03, 0x03, 0xE8, 0x01,
        0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x02, 0xC2, 0x01, 0x00}},
      {Encode(ToMicro(PanCommand{1.5708}), 9), {0x00, 0x08, 0x01, 0x03, 0x09, 0x3D, 0x5C, 0x56, 0xA0, 0x00}},
      {Encode(ToHost(HelloReply{.firmware = "merlin 0.1"}), 0),
       {0x00, 0x03, 0x01, 0x81, 0x0E, 0x01, 0x6D, 0x65, 0x72, 0x6C, 0x69, 0x6E, 0x20, 0x30, 0x2E, 0x31, 0x58, 0x61,
        0x00}},
      {Encode(ToHost(kState), 255), {0x00, 0x04, 0x01, 0x82, 0xFF, 0x14, 0x01, 0xE2, 0x40, 0xFF, 0xFE, 0xEE, 0x90,
                                     0x04, 0xD2, 0xFA, 0x24, 0x1C, 0x20, 0x09, 0x07, 0xC2, 0xA4, 0x8A, 0x25, 0x00}}};
  for (const auto& [encoded, by_hand] : encoded_and_by_hand) EXPECT_EQ(encoded, by_hand);
}

TEST(MicrocontrollerMessages, AreDecodedAsTheyWereEncoded) {
  const Command command{4'000'000'000u, -1.234567, 0.4363, milliseconds(65535)};
  EXPECT_EQ(Through(command), command);
  EXPECT_EQ(Single<ToMicro>(Encode(ToMicro(Hello{}), 1)), ToMicro(Hello{}));
  EXPECT_EQ(Single<ToMicro>(Encode(ToMicro(PanCommand{-0.5}), 1)), ToMicro(PanCommand{-0.5}));
  EXPECT_EQ(Single<ToHost>(Encode(ToHost(kState), 1)), ToHost(kState));
  State all_flags{.expired = true, .low_battery = true, .watchdog = true};
  EXPECT_EQ(Single<ToHost>(Encode(ToHost(all_flags), 1)), ToHost(all_flags));
  EXPECT_EQ(Single<ToHost>(Encode(ToHost(HelloReply{.firmware = ""}), 1)), ToHost(HelloReply{.firmware = ""}));
}

TEST(MicrocontrollerCommand, ThatIsNotFiniteExpiresNow) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_EQ(Through({9, bad, 0.1, milliseconds(500)}), (Command{.host_time_ms = 9}));
    EXPECT_EQ(Through({9, 0.5, bad, milliseconds(500)}), (Command{.host_time_ms = 9}));
  }
}

TEST(MicrocontrollerCommand, ThatHasExpiredIsAStop) {
  for (const Duration valid_for : {Duration(0), Duration(-1), Duration(999'999), Duration::min()})
    EXPECT_EQ(Through({9, 0.5, 0.1, valid_for}), (Command{.host_time_ms = 9}));
  EXPECT_EQ(Through({9, 0.5, 0.1, Duration(1'999'999)}).valid_for, milliseconds(1));  // never rounded up
}

TEST(MicrocontrollerCommand, IsClampedToWhatTheWireHolds) {
  const Command huge = Through({9, 1e30, -1e30, Duration::max()});
  EXPECT_NEAR(huge.speed_m_s, 2147.483647, 1e-9);
  EXPECT_NEAR(huge.steering_rad, -3.2768, 1e-12);
  EXPECT_EQ(huge.valid_for, milliseconds(65535));
}

TEST(MicrocontrollerPan, RefusesAnAngleThatIsNotFiniteByName) {
  try {
    Encode(ToMicro(PanCommand{kNaN}), 0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "microcontroller message: pan angle is not a finite number");
  }
}

TEST(MicrocontrollerState, RefusesNumbersThatAreNotFiniteAndClampsHugeOnes) {
  for (const double bad : {kNaN, kInfinity}) {
    EXPECT_THROW(Encode(ToHost(State{.steering_rad = bad}), 0), InputError);
    EXPECT_THROW(Encode(ToHost(State{.current_a = bad}), 0), InputError);
    EXPECT_THROW(Encode(ToHost(State{.battery_v = bad}), 0), InputError);
    EXPECT_THROW(Encode(ToHost(State{.pan_angle_rad = bad}), 0), InputError);
  }
  const auto state = std::get<State>(Single<ToHost>(Encode(ToHost(State{.current_a = 1e9, .battery_v = -1.0}), 0)));
  EXPECT_DOUBLE_EQ(state.current_a, 32.767);
  EXPECT_DOUBLE_EQ(state.battery_v, 0.0);
}

TEST(MicrocontrollerHelloReply, IsCutAndCleanedToFitAFrame) {
  const auto reply =
      std::get<HelloReply>(Single<ToHost>(Encode(ToHost(HelloReply{.firmware = std::string(200, 'x')}), 0)));
  EXPECT_EQ(reply.firmware, std::string(87, 'x'));
  EXPECT_LE(Encode(ToHost(HelloReply{.firmware = std::string(200, 'x')}), 0).size(), kFrameMax_bytes);
  EXPECT_EQ(std::get<HelloReply>(Single<ToHost>(Encode(ToHost(HelloReply{.firmware = "a\nb\xE4"}), 0))).firmware,
            "a?b?");
}

TEST(MicrocontrollerDecoder, RefusesAndCountsWhatItDoesNotKnow) {
  const std::vector<Frame> unknown{{.type = 0x02, .payload = Bytes(11)}, {.type = 0x02, .payload = Bytes(13)},
                                   {.type = 0x01, .payload = Bytes(1)},  {.type = 0x03, .payload = Bytes(0)},
                                   {.type = 0x82, .payload = Bytes(18)}, {.type = 0x7F}};
  Decoder<ToMicro> decoder;
  std::size_t bytes = 0;
  for (const Frame& frame : unknown) {
    EXPECT_TRUE(decoder.Feed(EncodeFrame(frame)).empty()) << int{frame.type};
    bytes += EncodeFrame(frame).size() - 2;  // the delimiters are not counted
  }
  EXPECT_EQ(decoder.counters().bad_payload, unknown.size());
  EXPECT_EQ(decoder.counters().frames, 0u);
  EXPECT_EQ(decoder.counters().garbage_bytes, bytes);
  Decoder<ToHost> host;
  EXPECT_TRUE(host.Feed(EncodeFrame({.type = 0x81, .payload = {1, '\n'}})).empty());
  EXPECT_TRUE(host.Feed(EncodeFrame({.type = 0x81})).empty());
}

}  // namespace
}  // namespace merlin::microcontroller
