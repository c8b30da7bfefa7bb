#include "robot/protocol/joystick.h"

#include <gtest/gtest.h>

namespace merlin::joystick {
namespace {

TEST(Joystick, ReadsAxesAndButtonsFromHandWrittenEvents) {
  Decoder decoder;
  decoder.Feed(Bytes{0x10, 0x27, 0x00, 0x00, 0xFF, 0x7F, 0x02, 0x01,    // 10000 ms: axis 1 at 32767
                     0x11, 0x27, 0x00, 0x00, 0x01, 0x80, 0x82, 0x00,    // state at opening: axis 0 at -32767
                     0x12, 0x27, 0x00, 0x00, 0x01, 0x00, 0x01, 0x05});  // button 5 pressed
  EXPECT_DOUBLE_EQ(decoder.state().axes[1], 1.0);
  EXPECT_DOUBLE_EQ(decoder.state().axes[0], -1.0);
  EXPECT_TRUE(decoder.state().buttons[5]);
  EXPECT_EQ(decoder.state().time_ms, 10002u);
  decoder.Feed(Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x00, 0x01, 0x05});  // released
  EXPECT_FALSE(decoder.state().buttons[5]);
  EXPECT_EQ(decoder.state().time_ms, 0xFFFFFFFFu);
  EXPECT_EQ(decoder.garbage_bytes(), 0u);
}

TEST(Joystick, ClampsTheOneValueBeyondFullScale) {
  Decoder decoder;
  decoder.Feed(Bytes{0, 0, 0, 0, 0x00, 0x80, 0x02, 0x00});  // -32768
  EXPECT_DOUBLE_EQ(decoder.state().axes[0], -1.0);
}

TEST(Joystick, IgnoresAndCountsUnknownEventsAndPieces) {
  Decoder decoder;
  decoder.Feed(Bytes{0, 0, 0, 0, 1, 0, 0x03, 0x00,  // no such type
                     0, 0, 0, 0, 1, 0, 0x01, 0x20,  // button 32
                     0, 0, 0, 0, 1, 0, 0x01, 0xFF,  // button 255
                     0, 0, 0});                     // half an event
  EXPECT_EQ(decoder.garbage_bytes(), 27u);
  for (const bool button : decoder.state().buttons) EXPECT_FALSE(button);
  decoder.Feed(Bytes{0, 0, 0, 0, 1, 0, 0x01, 0x1F});  // the next read is whole again
  EXPECT_TRUE(decoder.state().buttons[31]);
}

TEST(Joystick, ReadsNothingFromEmptyInput) {
  Decoder decoder;
  decoder.Feed({});
  EXPECT_EQ(decoder.garbage_bytes(), 0u);
  EXPECT_EQ(decoder.state().axes[0], 0.0);
}

}  // namespace
}  // namespace merlin::joystick
