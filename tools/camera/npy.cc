#include "tools/camera/npy.h"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <functional>
#include <numeric>

namespace merlin {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kAlignment = 64;  // of the data in the file
constexpr std::size_t kPreamble = 10;   // magic, version, length of the header

template <class Number>
std::string Npy(std::span<const Number> values, const std::vector<std::size_t>& shape, const char* type) {
  assert(std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()) == values.size());
  std::string tuple;
  for (const std::size_t length : shape) tuple += fmt::format("{}, ", length);
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, tuple);
  // Padded with blanks and closed by a line feed, so that the data begins on a multiple of the alignment.
  header.resize((kPreamble + header.size() + 1 + kAlignment - 1) / kAlignment * kAlignment - kPreamble - 1, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xFF);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return bytes;
}

}  // namespace

std::string ToNpy(std::span<const float> values, const std::vector<std::size_t>& shape) {
  return Npy(values, shape, "<f4");
}
std::string ToNpy(std::span<const double> values, const std::vector<std::size_t>& shape) {
  return Npy(values, shape, "<f8");
}
std::string ToNpy(std::span<const std::int32_t> values, const std::vector<std::size_t>& shape) {
  return Npy(values, shape, "<i4");
}
std::string ToNpy(std::span<const std::uint8_t> values, const std::vector<std::size_t>& shape) {
  return Npy(values, shape, "|u1");
}

}  // namespace merlin
