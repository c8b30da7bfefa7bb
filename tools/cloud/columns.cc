#include "tools/cloud/columns.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>

#include "robot/base/error.h"
#include "tools/cloud/text.h"

namespace merlin {
namespace {

constexpr double kReach_m = 1e9;
constexpr std::initializer_list<const char*> kX{"x", "points:0", "points_0", "easting"};
constexpr std::initializer_list<const char*> kY{"y", "points:1", "points_1", "northing"};
constexpr std::initializer_list<const char*> kZ{"z", "points:2", "points_2", "elevation"};

// In lower case and without a unit of metres: "X [m]", "x(m)" and "x_m" become x.
std::string Plain(std::string_view name) {
  std::string plain(name);
  std::ranges::transform(plain, plain.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view unit : {"_m", "[m]", "(m)"})
    if (plain.size() > unit.size() && plain.ends_with(unit)) plain.resize(plain.size() - unit.size());
  return std::string(cloud_text::Trim(plain));
}

// The column of the first of these names that exists.
std::optional<std::size_t> Find(const std::vector<std::string>& names, std::initializer_list<const char*> wanted,
                                const std::string& where) {
  for (const std::string name : wanted) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) continue;
    if (std::find(found + 1, names.end(), name) != names.end())
      throw InputError(where, "the column " + Quoted(name) + " is there twice");
    return static_cast<std::size_t>(found - names.begin());
  }
  return std::nullopt;
}

std::vector<std::string> Plain(std::span<const std::string_view> names) {
  std::vector<std::string> plain;
  for (const std::string_view name : names) plain.push_back(Plain(name));
  return plain;
}

}  // namespace

bool HaveCoordinates(std::span<const std::string_view> names) {
  const std::vector<std::string> plain = Plain(names);
  const auto has = [&plain](const char* name) { return std::ranges::find(plain, name) != plain.end(); };
  const auto has_one_of = [&has](const auto& wanted) { return std::ranges::any_of(wanted, has); };
  return has_one_of(kX) && has_one_of(kY) && has_one_of(kZ);
}

Columns::Columns(std::span<const std::string_view> names, const std::string& where) {
  const std::vector<std::string> plain = Plain(names);
  x_ = Find(plain, kX, where);
  y_ = Find(plain, kY, where);
  z_ = Find(plain, kZ, where);
  sigma_m_ = Find(plain, {"sigma"}, where);
  red_ = Find(plain, {"red", "r", "diffuse_red"}, where);
  green_ = Find(plain, {"green", "g", "diffuse_green"}, where);
  blue_ = Find(plain, {"blue", "b", "diffuse_blue"}, where);
  if (x_ && y_ && z_) return;
  throw InputError(where, "no coordinates", "columns x, y, z",
                   Quoted(names.empty() ? "" : names.front()) +
                       (names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : ""));
}

bool Columns::Used(std::size_t column) const {
  return column == x_ || column == y_ || column == z_ || column == sigma_m_ ||
         (colour() && (column == red_ || column == green_ || column == blue_));
}

void Columns::Add(std::span<const double> row, CloudFile& file) {
  const Eigen::Vector3d position(row[*x_], row[*y_], row[*z_]);
  const double sigma_m = sigma_m_ ? row[*sigma_m_] : 1.0;
  if (!(position.array().abs() <= kReach_m).all() || !(sigma_m > 0.0 && sigma_m <= kReach_m)) {
    ++file.left_out;
    return;
  }
  file.cloud.positions.push_back(position);
  if (sigma_m_) file.cloud.sigma_m.push_back(sigma_m);
  if (!colour()) return;
  const auto level = [&row](std::size_t column) {
    return row[column] >= 0.0 ? static_cast<float>(std::min(row[column], 1e9)) : 0.0f;
  };
  levels_.push_back({level(*red_), level(*green_), level(*blue_)});
}

void Columns::GiveColours(CloudFile& file, std::optional<bool> whole) {
  float most = 0.0f;
  bool fractions = !whole.value_or(true);
  for (const auto& levels : levels_)
    for (const float level : levels) {
      most = std::max(most, level);
      fractions = fractions || (!whole && level != std::floor(level));
    }
  constexpr float kRounding = 1e-3f;
  float full = 255.0f;
  if (fractions && most <= 1.0f + kRounding) full = 1.0f;
  if (most > 255.0f && most <= 65535.0f) full = 65535.0f;
  file.rgb.reserve(levels_.size());
  for (const auto& levels : levels_) {
    auto& rgb = file.rgb.emplace_back();
    for (std::size_t i = 0; i < 3; ++i)
      rgb[i] = static_cast<std::uint8_t>(std::lround(std::min(255.0 * levels[i] / full, 255.0)));
  }
}

}  // namespace merlin
