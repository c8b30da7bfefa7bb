// CRC, byte stuffing and frames against hand-written bytes. The frames' CRCs come from Python's binascii.crc_hqx.
#include "robot/protocol/frame.h"

#include <gtest/gtest.h>

#include "robot/protocol/cobs.h"
#include "robot/protocol/crc16.h"

namespace merlin {
namespace {

const Bytes kHelloWire{0x00, 0x03, 0x01, 0x01, 0x03, 0xC8, 0x9D, 0x00};  // sequence number 0

Bytes Joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes FromText(const std::string& text) { return Bytes(text.begin(), text.end()); }

Frame Numbered(std::uint8_t sequence) { return {.type = 0x02, .sequence = sequence, .payload = {9, 0, 8}}; }

TEST(Crc16, GivesTheCheckValueOfItsCatalogue) { EXPECT_EQ(Crc16(FromText("123456789")), 0x29B1); }

TEST(Crc16, OfNoBytesIsTheInitialValue) { EXPECT_EQ(Crc16({}), 0xFFFF); }

// Cheshire and Baker's examples, and the block of 254.
TEST(Cobs, EncodesAndDecodesExamplesByHand) {
  const std::vector<std::pair<Bytes, Bytes>> pairs{
      {{}, {0x01}},
      {{0x00}, {0x01, 0x01}},
      {{0x00, 0x00}, {0x01, 0x01, 0x01}},
      {{0x11, 0x22, 0x00, 0x33}, {0x03, 0x11, 0x22, 0x02, 0x33}},
      {{0x11, 0x00, 0x00, 0x00}, {0x02, 0x11, 0x01, 0x01, 0x01}},
      {Bytes(254, 7), Joined({{0xFF}, Bytes(254, 7)})},
      {Bytes(255, 7), Joined({{0xFF}, Bytes(254, 7), {0x02, 7}})},
      {Joined({Bytes(254, 7), {0}}), Joined({{0xFF}, Bytes(254, 7), {0x01, 0x01}})},
  };
  for (const auto& [plain, stuffed] : pairs) {
    EXPECT_EQ(CobsEncode(plain), stuffed);
    EXPECT_EQ(CobsDecode(stuffed), plain);
  }
}

TEST(Cobs, RefusesWhatNoEncoderGives) {
  EXPECT_FALSE(CobsDecode(Bytes{0x03, 0x11}));  // block longer than what is there
  EXPECT_FALSE(CobsDecode(Bytes{0x00}));        // a zero
  EXPECT_FALSE(CobsDecode(Bytes{0x03, 0x00, 0x11}));
}

TEST(FrameCode, IsAsWrittenByHand) { EXPECT_EQ(EncodeFrame({.type = 0x01}), kHelloWire); }

TEST(FrameCode, LongestFitsTheRadiosPacket) {
  for (const std::uint8_t filling : {0x00, 0x01, 0xFF}) {
    const Frame longest{.type = 0x02, .payload = Bytes(kPayloadMax_bytes, filling)};
    EXPECT_EQ(EncodeFrame(longest).size(), 96u);
    FrameDecoder decoder;
    const auto frames = decoder.Feed(EncodeFrame(longest));
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].payload, longest.payload);
  }
}

TEST(FrameDecoder, ReadsFramesInPiecesOfAnySize) {
  const Bytes wire = Joined({EncodeFrame(Numbered(1)), EncodeFrame(Numbered(2)), EncodeFrame(Numbered(3))});
  for (std::size_t piece = 1; piece <= wire.size(); ++piece) {
    FrameDecoder decoder;
    std::vector<Frame> frames;
    for (std::size_t at = 0; at < wire.size(); at += piece)
      for (Frame& frame : decoder.Feed(BytesView(wire).subspan(at, std::min(piece, wire.size() - at))))
        frames.push_back(frame);
    ASSERT_EQ(frames.size(), 3u) << piece;
    EXPECT_EQ(frames[2].sequence, 3);
    EXPECT_EQ(frames[2].payload, Numbered(3).payload);
    EXPECT_EQ(decoder.counters().garbage_bytes, 0u);
  }
}

TEST(FrameDecoder, LosesNoFrameToGarbageBeforeIt) {
  for (const Bytes& garbage : {Bytes{0x55}, Bytes(93, 0x55), Bytes(94, 0x55), Bytes(95, 0x55), Bytes(5000, 0xFF)}) {
    FrameDecoder decoder;
    EXPECT_EQ(decoder.Feed(Joined({garbage, EncodeFrame(Numbered(1))})).size(), 1u) << garbage.size();
    EXPECT_EQ(decoder.counters().garbage_bytes, garbage.size());
  }
}

TEST(FrameDecoder, FindsEveryFlippedBitAndReadsTheNextFrame) {
  const Bytes good = EncodeFrame(Numbered(1));
  for (std::size_t bit = 8; bit < 8 * (good.size() - 1); ++bit) {  // the delimiters apart
    Bytes bad = good;
    bad[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    FrameDecoder decoder;
    const auto frames = decoder.Feed(Joined({bad, EncodeFrame(Numbered(2))}));
    ASSERT_EQ(frames.size(), 1u) << bit;
    EXPECT_EQ(frames[0].sequence, 2);
    EXPECT_GT(decoder.counters().garbage_bytes, 0u);
  }
}

TEST(FrameDecoder, CountsABadCrc) {
  Bytes bad = EncodeFrame(Numbered(1));
  bad[bad.size() - 2] ^= 0x10;  // the CRC's last byte
  FrameDecoder decoder;
  decoder.Feed(bad);
  EXPECT_EQ(decoder.counters().bad_crc, 1u);
}

TEST(FrameDecoder, ReadsNothingOfAFrameCutShort) {
  const Bytes whole = EncodeFrame(Numbered(1));
  for (std::size_t size = 0; size < whole.size() - 1; ++size) {
    FrameDecoder decoder;
    EXPECT_TRUE(decoder.Feed(BytesView(whole).first(size)).empty());
    EXPECT_EQ(decoder.Feed(EncodeFrame(Numbered(2))).size(), 1u);
  }
}

TEST(FrameDecoder, CountsLostNumbersAcrossTheWrapAndRepeatedOnes) {
  FrameDecoder decoder;
  for (const std::uint8_t sequence : {250, 253, 255, 0, 0, 2})
    EXPECT_EQ(decoder.Feed(EncodeFrame(Numbered(sequence))).size(), 1u);
  EXPECT_EQ(decoder.counters().lost, 2u + 1u + 0u + 1u);
  EXPECT_EQ(decoder.counters().repeated, 1u);
  EXPECT_EQ(decoder.counters().frames, 6u);
}

// Version 2 of a command (type 2) and of a greeting (type 1), CRCs by hand-run binascii.
TEST(FrameDecoder, TellsAnotherVersionAndReadsOnlyItsGreeting) {
  const auto wire = [](std::uint8_t version, std::uint8_t type) {
    Bytes plain{version, type, 0x05};
    Put(plain, Crc16(plain));
    return Joined({{0}, CobsEncode(plain), {0}});
  };
  FrameDecoder decoder;
  EXPECT_TRUE(decoder.Feed(wire(2, 0x02)).empty());
  EXPECT_EQ(decoder.counters().other_version, 1u);
  EXPECT_EQ(decoder.other_version(), 2);
  EXPECT_EQ(decoder.Feed(wire(2, 0x01)).size(), 1u);
  EXPECT_EQ(decoder.Feed(wire(3, 0x81)).size(), 1u);
  EXPECT_EQ(decoder.other_version(), 3);
}

TEST(FrameDecoder, TakesZerosForNothing) {
  FrameDecoder decoder;
  EXPECT_TRUE(decoder.Feed(Bytes(1000, 0)).empty());
  EXPECT_EQ(decoder.counters().garbage_bytes, 0u);
}

}  // namespace
}  // namespace merlin
