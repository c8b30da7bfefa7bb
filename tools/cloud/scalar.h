// Reads numbers of any type and byte order from binary data as doubles, and keeps the position for error messages.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "robot/base/error.h"

namespace merlin {

enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat, kDouble };

constexpr std::size_t SizeOf(Scalar type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

constexpr bool IsWhole(Scalar type) { return type != Scalar::kFloat && type != Scalar::kDouble; }

// A warning about bytes that follow the data.
inline std::string BytesBehind(const std::string& name, std::size_t count) {
  return name + ": " + std::to_string(count) + " bytes behind the data that the header announces are not read";
}

class BinaryReader {
 public:
  // offset: position of the data in the file, for error messages.
  BinaryReader(std::string_view data, std::endian order, std::size_t offset, std::string name)
      : data_(data), order_(order), offset_(offset), name_(std::move(name)) {}

  double Read(Scalar type) {
    switch (type) {
      case Scalar::kInt8:
        return As<std::int8_t>();
      case Scalar::kUint8:
        return As<std::uint8_t>();
      case Scalar::kInt16:
        return As<std::int16_t>();
      case Scalar::kUint16:
        return As<std::uint16_t>();
      case Scalar::kInt32:
        return As<std::int32_t>();
      case Scalar::kUint32:
        return As<std::uint32_t>();
      case Scalar::kInt64:
        return static_cast<double>(As<std::int64_t>());
      case Scalar::kUint64:
        return static_cast<double>(As<std::uint64_t>());
      case Scalar::kFloat:
        return As<float>();
      case Scalar::kDouble:
        return As<double>();
    }
    return 0.0;
  }

  // Skips count values of `size` bytes. Both numbers come from the file and may be too large.
  void Skip(std::size_t count, std::size_t size) {
    if (count > left() / size) throw InputError(Where(), "the file ends within the data");
    at_ += count * size;
  }
  std::size_t left() const { return data_.size() - at_; }
  std::string Where() const { return name_ + ": byte " + std::to_string(offset_ + at_); }

 private:
  template <class Number>
  Number As() {
    unsigned char raw[sizeof(Number)];
    if (left() < sizeof(Number)) throw InputError(Where(), "the file ends within the data");
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      raw[order_ == std::endian::native ? i : sizeof(Number) - 1 - i] = static_cast<unsigned char>(data_[at_ + i]);
    at_ += sizeof(Number);
    Number number;
    std::memcpy(&number, raw, sizeof(Number));
    return number;
  }

  std::string_view data_;
  std::endian order_;
  std::size_t offset_, at_ = 0;
  std::string name_;
};

}  // namespace merlin
