#include "tools/cloud/columns.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "robot/types/error.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

constexpr double kReach_m = 1e9;

std::optional<std::size_t> Find(std::span<const std::string_view> names, const char* wanted, const std::string& where) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name(names[i]);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name != wanted && name != std::string(wanted) + "_m") continue;
    if (found) throw InputError(where, "the column " + cloud_text::Quoted(wanted) + " is there twice");
    found = i;
  }
  return found;
}

std::uint8_t Level(double value) {
  return value >= 0.0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 255.0))) : std::uint8_t{0};
}

}  // namespace

Columns::Columns(std::span<const std::string_view> names, const std::string& where)
    : x_(Find(names, "x", where)),
      y_(Find(names, "y", where)),
      z_(Find(names, "z", where)),
      sigma_m_(Find(names, "sigma", where)),
      red_(Find(names, "red", where)),
      green_(Find(names, "green", where)),
      blue_(Find(names, "blue", where)) {
  if (x_ && y_ && z_) return;
  throw InputError(where, "no coordinates", "columns x, y, z",
                   cloud_text::Quoted(names.empty() ? "" : names.front()) +
                       (names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : ""));
}

void Columns::Add(std::span<const double> row, CloudFile& file) const {
  const Eigen::Vector3d position(row[*x_], row[*y_], row[*z_]);
  const double sigma_m = sigma_m_ ? row[*sigma_m_] : 1.0;
  if (!(position.array().abs() <= kReach_m).all() || !(sigma_m > 0.0 && sigma_m <= kReach_m)) {
    ++file.left_out;
    return;
  }
  file.cloud.positions.push_back(position);
  if (sigma_m_) file.cloud.sigma_m.push_back(sigma_m);
  if (red_ && green_ && blue_) file.rgb.push_back({Level(row[*red_]), Level(row[*green_]), Level(row[*blue_])});
}

}  // namespace merlin
