// Which columns of a file's rows are what, and how a row becomes a point.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tools/cloud/cloud_file.h"

namespace merlin {

class Columns {
 public:
  // The file's columns by name, in any case, in their order. Throws InputError at `where` without x, y, z, or with one
  // of the names we know given twice.
  Columns(std::span<const std::string_view> names, const std::string& where);

  // One value a column.
  void Add(std::span<const double> row, CloudFile& file) const;

 private:
  std::optional<std::size_t> x_, y_, z_, sigma_m_, red_, green_, blue_;
};

}  // namespace merlin
