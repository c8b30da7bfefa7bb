#include "robot/base/sha256.h"

#include <gtest/gtest.h>

#include <vector>

namespace merlin {
namespace {

// FIPS 180-2, appendix B, and the digest of empty input.
constexpr char kEmpty[] = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr char kAbc[] = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(Sha256, GivesTheKnownDigests) {
  EXPECT_EQ(Sha256().Hex(), kEmpty);
  Sha256 hash;
  hash.Add("abc");
  EXPECT_EQ(hash.Hex(), kAbc);
}

TEST(Sha256, DoesNotSeeWhereThePiecesEnd) {
  Sha256 hash;
  hash.Add("a");
  hash.Add("");
  EXPECT_NE(hash.Hex(), kAbc);
  hash.Add("bc");  // goes on after Hex
  EXPECT_EQ(hash.Hex(), kAbc);
  EXPECT_EQ(hash.Hex(), kAbc);
  Sha256 moved = std::move(hash);
  EXPECT_EQ(moved.Hex(), kAbc);
}

TEST(Sha256, TakesNumbersAsLittleEndianBytes) {
  Sha256 numbers, bytes;
  numbers.Add(1.0);  // 0x3ff0000000000000
  numbers.Add(std::uint16_t{0x6261});
  numbers.Add(std::span<const float>(std::vector<float>{-2.0f, 0.0f}));  // 0xc0000000
  numbers.Add(std::span<const std::uint8_t>());
  bytes.Add(
      std::string_view("\0\0\0\0\0\0\xf0\x3f"
                       "ab"
                       "\0\0\0\xc0\0\0\0\0",
                       18));
  EXPECT_EQ(numbers.Hex(), bytes.Hex());
}

}  // namespace
}  // namespace merlin
