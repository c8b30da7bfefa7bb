// Text as bytes of UTF-8 (RFC 3629), one character at a time. It need not be valid: a file's name may hold any bytes.
#pragma once

#include <cstddef>
#include <string_view>

namespace merlin {

struct Utf8Character {
  char32_t code = U'\uFFFD';  // U+FFFD, the replacement character, for bytes that are no UTF-8
  std::size_t bytes = 0;      // its length, 1 to 4; of invalid text as many bytes as could have begun a character
  bool valid = false;
};

// The first character of a text that is not empty. Overlong forms, surrogates and codes above U+10FFFF are invalid.
inline Utf8Character FirstCharacter(std::string_view text) {
  const auto byte = [text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const bool is_lead = lead >= 0xC2 && lead <= 0xF4;
  const std::size_t length = !is_lead ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  // The Unicode Standard, table 3-7: some leads narrow what may come second.
  unsigned low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  unsigned high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  char32_t code = lead & (0x7Fu >> length);
  std::size_t i = 1;
  for (; i < length && byte(i) >= low && byte(i) <= high; ++i, low = 0x80, high = 0xBF)
    code = code << 6 | (byte(i) & 0x3F);
  if (!is_lead || i < length) return {.bytes = i};
  return {code, length, true};
}

}  // namespace merlin
