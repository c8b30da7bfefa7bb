// Clouds from files: PLY (ascii, binary of either byte order), PCD (ascii, binary) and CSV (.csv, .txt, .xyz).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "slam/register/cloud.h"

namespace merlin {

struct CloudFile {
  Cloud cloud;                                     // sigma_m where the file has a column of that name
  std::vector<std::array<std::uint8_t, 3>> rgb{};  // red, green, blue [0, 255], where a PLY has them; else empty
  std::size_t left_out = 0;  // points that are not finite, beyond 1e9 m, or of a sigma_m not above 0
};

// By the name's ending. Throws InputError: where (line, or byte of binary data), what, expected, got. Asks for memory
// only for points that the file has.
CloudFile ReadCloud(const std::filesystem::path& file);

// The formats themselves; `name` is the file's, for what they throw.
// PLY (G. Turk, 1994): x, y, z of the element vertex; other properties, lists and elements are read over.
CloudFile ParsePly(std::string_view bytes, const std::string& name);
// PCD 0.7 (pointclouds.org): the fields x, y, z; not binary_compressed. The viewpoint does not move the points.
CloudFile ParsePcd(std::string_view bytes, const std::string& name);
// Columns between commas, semicolons, or blanks; a header of names (x or x_m, ...) or none: then the first three are
// x, y, z. Lines that begin with # are remarks.
CloudFile ParseCsv(std::string_view bytes, const std::string& name);

}  // namespace merlin
