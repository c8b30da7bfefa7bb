// Finds out what each column of a file means, and turns rows into points.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cloud/cloud_file.h"

namespace merlin {

// Whether x, y and z are among these names.
bool HaveCoordinates(std::span<const std::string_view> names);

class Columns {
 public:
  // names: of the columns, in order; upper or lower case, with or without a unit. Known are for coordinates x, y, z, or
  // Points:0 ... (ParaView), or Easting, Northing, Elevation; for colours red, green, blue, or r, g, b, or diffuse_red ...
  // Throws InputError that begins with `where` if coordinates are missing, or if a known name appears twice.
  Columns(std::span<const std::string_view> names, const std::string& where);

  // Whether the values of that column are needed. Other columns may contain anything.
  bool Used(std::size_t column) const;
  // The column of red, if all three colours are there.
  std::optional<std::size_t> colour() const { return red_ && green_ && blue_ ? red_ : std::nullopt; }

  // Adds a point. row: one value per column.
  void Add(std::span<const double> row, CloudFile& file);

  // Must be called last: gives the points their colours, scaled to [0, 255]. Values of which all are at most 1 count as
  // fractions of 1; if any exceeds 255, as 16-bit numbers; else they are taken as they are. whole: whether the file's type is
  // an integer; not given: the values decide.
  void GiveColours(CloudFile& file, std::optional<bool> whole);

 private:
  std::optional<std::size_t> x_, y_, z_, sigma_m_, red_, green_, blue_;
  std::vector<std::array<float, 3>> levels_;  // as they are in the file
};

}  // namespace merlin
