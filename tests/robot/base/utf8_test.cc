#include "robot/base/utf8.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace merlin {
namespace {

// RFC 3629, section 3, by its table.
std::string Encoded(char32_t c) {
  const auto tail = [c](int shift) { return static_cast<char>(0x80 | (c >> shift & 0x3F)); };
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xC0 | c >> 6), tail(0)};
  if (c < 0x10000) return {static_cast<char>(0xE0 | c >> 12), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | c >> 18), tail(12), tail(6), tail(0)};
}

TEST(Utf8, EveryCodeIsReadBackAndSurrogatesAreNone) {
  for (char32_t code = 0; code <= 0x110000; ++code) {
    const std::string text = Encoded(code);
    const Utf8Character first = FirstCharacter(text + "x");
    const bool is_character = code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    ASSERT_EQ(first.valid, is_character) << static_cast<unsigned>(code);
    ASSERT_TRUE(first.code == (is_character ? code : U'\uFFFD')) << static_cast<unsigned>(code);
    if (is_character) {
      ASSERT_EQ(first.bytes, text.size()) << static_cast<unsigned>(code);
    }
  }
}

TEST(Utf8, WhatIsCutShortOrOverlongIsInvalid) {
  for (const char* text : {"\x80", "\xC0\x80", "\xC1\xBF", "\xE0\x80\x80", "\xE0\x9F\xBF", "\xF0\x80\x80\x80",
                           "\xF0\x8F\xBF\xBF", "\xF5\x80\x80\x80", "\xFF", "\xC3", "\xC3(", "\xE2\x82", "\xF0\x9F\x99"})
    EXPECT_FALSE(FirstCharacter(text).valid) << text;
  EXPECT_EQ(FirstCharacter("\xE2\x82x").bytes, 2u);  // the x is a character of its own
  EXPECT_EQ(FirstCharacter("\xE0\x80").bytes, 1u);
}

TEST(Utf8, AnyBytesAreWalkedToTheirEnd) {
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    std::string text(random() % 12, ' ');
    for (char& c : text) c = static_cast<char>(random());
    std::string_view rest = text;
    while (!rest.empty()) {
      const Utf8Character first = FirstCharacter(rest);
      ASSERT_GE(first.bytes, 1u);
      ASSERT_LE(first.bytes, rest.size());
      if (first.valid) {
        ASSERT_EQ(Encoded(first.code), rest.substr(0, first.bytes));
      }
      rest.remove_prefix(first.bytes);
    }
  }
}

}  // namespace
}  // namespace merlin
