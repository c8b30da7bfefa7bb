// Bytes as they are on the wire: numbers are big-endian, as the 3DM sends them.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace merlin {

using Bytes = std::vector<std::uint8_t>;
using BytesView = std::span<const std::uint8_t>;

template <std::integral T>
void Put(Bytes& bytes, T value) {
  const auto bits = static_cast<std::make_unsigned_t<T>>(value);
  for (std::size_t i = sizeof(T); i-- > 0;) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
}

// Reads numbers from the front. The caller must have checked that there are enough bytes.
class ByteReader {
 public:
  explicit ByteReader(BytesView bytes) : bytes_(bytes) {}

  template <std::integral T>
  T Take() {
    assert(bytes_.size() >= sizeof(T));
    std::make_unsigned_t<T> bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits = static_cast<std::make_unsigned_t<T>>((std::uint64_t{bits} << 8) | bytes_[i]);
    bytes_ = bytes_.subspan(sizeof(T));
    return static_cast<T>(bits);
  }

 private:
  BytesView bytes_;
};

}  // namespace merlin
