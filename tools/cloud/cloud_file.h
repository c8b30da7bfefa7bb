// Clouds from files: PLY (ascii, binary of either byte order), PCD (ascii, binary, binary_compressed) and columns of
// text (.csv, .txt, .xyz, .asc, .pts).
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
  std::vector<std::array<std::uint8_t, 3>> rgb{};  // red, green, blue [0, 255], where columns have them; else empty
  std::size_t left_out = 0;             // points that are empty, not finite, beyond 1e9 m, or of a sigma_m not above 0
  std::vector<std::string> warnings{};  // a sentence each: what else of the file was not read, or how it was
};

// By the name's ending. Throws InputError with every fault: where (line, or byte of binary data), what, expected, got.
// Asks for memory only for points that the file has. A byte-order mark is ignored.
CloudFile ReadCloud(const std::filesystem::path& file);

// The formats themselves; `name` is the file's, for what they throw.
// PLY (G. Turk, 1994): x, y, z and colours of the element vertex; other properties, lists and elements are read over.
// Bytes behind binary data are left, with a warning.
CloudFile ParsePly(std::string_view bytes, const std::string& name);
// PCD 0.7 (pointclouds.org): the fields x, y, z; bytes behind binary data as above. The viewpoint does not move the
// points.
CloudFile ParsePcd(std::string_view bytes, const std::string& name);
// Columns between commas, semicolons, tabs or blanks. A header of names (columns.h), perhaps behind # or //, or none:
// then the first three are x, y, z. Columns that are not used may hold any text, or nothing. A line of one whole number
// before the points is their count. Decimal commas are read where commas separate nothing, with a warning. Other lines
// that begin with #, // or % are remarks.
CloudFile ParseCsv(std::string_view bytes, const std::string& name);

}  // namespace merlin
