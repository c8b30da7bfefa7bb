// Which columns of a file's rows are what, and how rows become points.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cloud/cloud_file.h"

namespace merlin {

// Whether these names have columns x, y and z.
bool HaveCoordinates(std::span<const std::string_view> names);

class Columns {
 public:
  // The file's columns by name, in any case, with or without their unit, in their order. Coordinates: x, y, z; Points:0
  // ... (ParaView); Easting, Northing, Elevation. Colours: red, green, blue; r, g, b; diffuse_red ... Throws InputError
  // at `where` without coordinates, or with one of the names we know given twice.
  Columns(std::span<const std::string_view> names, const std::string& where);

  // Whether a point's value in that column counts; the others may hold anything.
  bool Used(std::size_t column) const;
  // The first column of colours, where all three are there.
  std::optional<std::size_t> colour() const { return red_ && green_ && blue_ ? red_ : std::nullopt; }

  // One value a column.
  void Add(std::span<const double> row, CloudFile& file);

  // To be called last: gives the points their colours. Fractions up to 1 are shares of 255, numbers beyond 255 of
  // 65535, others are [0, 255] as they are. whole: whether they are whole numbers by their type; unknown: by their
  // values.
  void GiveColours(CloudFile& file, std::optional<bool> whole);

 private:
  std::optional<std::size_t> x_, y_, z_, sigma_m_, red_, green_, blue_;
  std::vector<std::array<float, 3>> levels_;  // as they are in the file
};

}  // namespace merlin
