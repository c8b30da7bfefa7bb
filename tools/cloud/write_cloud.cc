#include "tools/cloud/write_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <iterator>

namespace merlin {
namespace {

static_assert(std::endian::native == std::endian::little);  // the bytes of numbers are copied

constexpr double kFloatError_m_max = 0.5e-4;
constexpr Rgb kGrey{200, 200, 200};

bool FloatsSuffice(std::span<const Eigen::Vector3d> positions) {
  return std::ranges::all_of(positions, [](const Eigen::Vector3d& position) {
    return (position.cast<float>().cast<double>() - position).norm() <= kFloatError_m_max;
  });
}

template <class Value>
void AppendBytes(std::string& bytes, const Value& value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

void AppendPosition(std::string& bytes, const Eigen::Vector3d& position, bool floats) {
  for (const double coordinate_m : position) {
    if (floats)
      AppendBytes(bytes, static_cast<float>(coordinate_m));
    else
      AppendBytes(bytes, coordinate_m);
  }
}

std::string ToPly(std::span<const Eigen::Vector3d> positions, std::span<const Rgb> rgb) {
  const bool floats = FloatsSuffice(positions);
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {0}\nproperty {1} x\nproperty {1} y\nproperty {1} z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      positions.size(), floats ? "float" : "double");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    AppendPosition(bytes, positions[i], floats);
    for (const std::uint8_t value : rgb.empty() ? kGrey : rgb[i]) AppendBytes(bytes, value);
  }
  return bytes;
}

// PCL's rgb: a 4-byte number, whose bytes from the highest are 0, red, green, blue.
std::string ToPcd(std::span<const Eigen::Vector3d> positions, std::span<const Rgb> rgb) {
  const bool floats = FloatsSuffice(positions), colored = !rgb.empty();
  std::string bytes = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{1}\nSIZE {2} {2} {2}{3}\n"
      "TYPE F F F{4}\nCOUNT 1 1 1{5}\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      positions.size(), colored ? " rgb" : "", floats ? 4 : 8, colored ? " 4" : "", colored ? " U" : "",
      colored ? " 1" : "");
  for (std::size_t i = 0; i < positions.size(); ++i) {
    AppendPosition(bytes, positions[i], floats);
    if (colored) AppendBytes(bytes, std::uint32_t{rgb[i][0]} << 16 | std::uint32_t{rgb[i][1]} << 8 | rgb[i][2]);
  }
  return bytes;
}

std::string ToCsv(std::span<const Eigen::Vector3d> positions, std::span<const Rgb> rgb) {
  std::string text = rgb.empty() ? "x,y,z\n" : "x,y,z,red,green,blue\n";
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    fmt::format_to(out, "{},{},{}", positions[i].x(), positions[i].y(), positions[i].z());
    if (!rgb.empty()) fmt::format_to(out, ",{},{},{}", rgb[i][0], rgb[i][1], rgb[i][2]);
    text += '\n';
  }
  return text;
}

}  // namespace

std::string ToCloud(const std::filesystem::path& name, std::span<const Eigen::Vector3d> positions,
                    std::span<const Rgb> rgb) {
  std::string ending = name.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".pcd" ? ToPcd(positions, rgb) : ending == ".csv" ? ToCsv(positions, rgb) : ToPly(positions, rgb);
}

}  // namespace merlin
