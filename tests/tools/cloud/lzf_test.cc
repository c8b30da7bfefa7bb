#include "tools/cloud/lzf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "robot/base/error.h"

namespace merlin {
namespace {

std::string Decompress(const std::string& data, std::size_t size) { return DecompressLzf(data, size, 100, "f"); }

// By hand: 3 bytes "abc"; 5 bytes (3 + 2) from 3 back, which overlap: "abcab"; 10 bytes (7 + 1 + 2) from 1 back.
TEST(Lzf, GivesAStringWorkedByHand) {
  EXPECT_EQ(Decompress(std::string("\x02"
                                   "abc"
                                   "\x60\x02"
                                   "\xe0\x01\x00",
                                   9),
                       18),
            "abcabcabbbbbbbbbbb");
  EXPECT_EQ(Decompress("", 0), "");
  EXPECT_EQ(Decompress(std::string("\x00z", 2), 1), "z");
}

// The farthest and the longest that the format can say: 8192 back, 264 bytes.
TEST(Lzf, ReachesAsFarAsTheFormat) {
  std::string data, expected;
  for (int i = 0; i < 8192; i += 32) {
    data += '\x1f';
    for (int j = 0; j < 32; ++j) data += static_cast<char>((i + j) * 7 / 5), expected += data.back();
  }
  expected += expected.substr(0, 264);
  EXPECT_EQ(Decompress(data + "\xff\xff\xff", expected.size()), expected);
}

// A brute-force encoder: at each position it uses the longest match in the data before (which may overlap), or literal
// bytes.
std::string Compressed(const std::string& text, bool repeat) {
  std::string out, plain;
  const auto flush = [&] {
    for (std::size_t at = 0; at < plain.size(); at += 32) {
      const std::string run = plain.substr(at, 32);
      out += static_cast<char>(run.size() - 1);
      out += run;
    }
    plain.clear();
  };
  for (std::size_t at = 0; at < text.size();) {
    std::size_t best = 0, best_back = 0;
    for (std::size_t back = 1; repeat && back <= std::min<std::size_t>(at, 8192); ++back) {
      std::size_t length = 0;
      while (length < 264 && at + length < text.size() && text[at + length - back] == text[at + length]) ++length;
      if (length > best) best = length, best_back = back;
    }
    if (best < 3) {
      plain += text[at++];
      continue;
    }
    flush();
    const std::size_t code = best - 2, distance = best_back - 1;
    out += static_cast<char>(std::min<std::size_t>(code, 7) << 5 | distance >> 8);
    if (code >= 7) out += static_cast<char>(code - 7);
    out += static_cast<char>(distance & 255);
    at += best;
  }
  flush();
  return out;
}

TEST(Lzf, UndoesAnEncoder) {
  std::mt19937 random(1);
  for (const unsigned letters : {1u, 2u, 3u, 256u})
    for (const std::size_t size : {1u, 2u, 31u, 32u, 33u, 65u, 300u, 3000u}) {
      std::string text;
      for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(random() % letters);
      EXPECT_EQ(Decompress(Compressed(text, false), size), text) << letters << " " << size;
      const std::string compressed = Compressed(text, true);
      EXPECT_EQ(Decompress(compressed, size), text) << letters << " " << size;
      EXPECT_LE(compressed.size(), letters == 1 ? 6 + size / 64 : size + size / 32 + 1);
    }
}

void ExpectLzfRefused(const std::string& data, std::size_t size, const std::string& part) {
  try {
    Decompress(data, size);
    ADD_FAILURE() << part;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Lzf, RefusesWithTheByte) {
  ExpectLzfRefused("", 1, "f: byte 100: the compressed data give fewer bytes than they say; expected 1, got 0");
  ExpectLzfRefused(
      "\x02"
      "ab",
      3, "f: byte 101: the compressed data end within a run");
  ExpectLzfRefused(
      "\x02"
      "abc\x60",
      8, "byte 105: the compressed data end within a run");
  ExpectLzfRefused(
      "\x02"
      "abc\xe0",
      20, "byte 105: the compressed data end within a run");
  ExpectLzfRefused(
      "\x02"
      "abc\xe0\x01",
      20, "byte 106: the compressed data end within a run");
  ExpectLzfRefused(
      "\x02"
      "abc\x60\x03",
      8, "byte 106: the compressed data repeat what is before their start");
  ExpectLzfRefused(std::string("\x60\x00", 2), 5, "before their start");
  ExpectLzfRefused(
      "\x02"
      "abc",
      2, "more bytes than they say");
  ExpectLzfRefused(
      "\x02"
      "abc\x60\x02",
      7, "more bytes than they say");
  ExpectLzfRefused(
      "\x02"
      "abc\x60\x02",
      9, "fewer bytes than they say; expected 9, got 8");
}

}  // namespace
}  // namespace merlin
