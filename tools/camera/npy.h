// NumPy's array file, version 1.0 (numpy.lib.format): what Python reads with numpy.load.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace merlin {

// The bytes of a file of this shape, row-major, little-endian. The product of the shape is the number of values.
std::string ToNpy(std::span<const float> values, const std::vector<std::size_t>& shape);
std::string ToNpy(std::span<const double> values, const std::vector<std::size_t>& shape);
std::string ToNpy(std::span<const std::int32_t> values, const std::vector<std::size_t>& shape);
std::string ToNpy(std::span<const std::uint8_t> values, const std::vector<std::size_t>& shape);

}  // namespace merlin
