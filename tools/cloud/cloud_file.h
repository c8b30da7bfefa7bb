// Reads point clouds from files: PLY (ASCII, binary in either byte order), PCD (ASCII, binary, binary_compressed) and columns
// of text (.csv, .txt, .xyz, .asc, .pts).
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
  // Points that were not taken: empty, not finite, farther than 1e9 m, or with a sigma_m that is not positive.
  std::size_t left_out = 0;
  std::vector<std::string> warnings{};  // one sentence each: what else was not read, or read in an unusual manner
};

// The ending of the name tells the format. Throws InputError that says where (line, or byte of binary data), what, expected
// and got. Takes memory only for points that are really in the file, whatever its header claims. Ignores a byte-order mark.
CloudFile ReadCloud(const std::filesystem::path& file);

// The three formats. `name` is the name of the file, for error messages.
//
// PLY (G. Turk, 1994): takes x, y, z and colours of the element `vertex` and skips other properties, lists and elements. Bytes
// behind the data of a binary file give a warning.
CloudFile ParsePly(std::string_view bytes, const std::string& name);
// PCD 0.7 (pointclouds.org): takes the fields x, y, z and the colour; bytes behind the data as above. The viewpoint does not
// move the points.
CloudFile ParsePcd(std::string_view bytes, const std::string& name);
// Text: columns are separated by commas, semicolons, tabs or blanks. A header line may name them (columns.h), also behind #
// or //; without a header the first three are x, y, z. Columns that are not used may contain any text, or none. A line with a
// single whole number before the points is their count. Decimal commas are accepted, with a warning, if commas do not
// separate the columns. Other lines that start with #, // or % are comments.
CloudFile ParseCsv(std::string_view bytes, const std::string& name);

}  // namespace merlin
