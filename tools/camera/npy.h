// Writes arrays in NumPy's file format, version 1.0 (NumPy manual, numpy.lib.format); Python reads it with numpy.load.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace merlin {

// The bytes of a file: row-major, little-endian. The product of the shape must be the number of values.
std::string ToNpy(std::span<const float> values, const std::vector<std::size_t>& shape);
std::string ToNpy(std::span<const double> values, const std::vector<std::size_t>& shape);
std::string ToNpy(std::span<const std::int32_t> values, const std::vector<std::size_t>& shape);
std::string ToNpy(std::span<const std::uint8_t> values, const std::vector<std::size_t>& shape);

}  // namespace merlin
