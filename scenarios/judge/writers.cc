#include "scenarios/judge/writers.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cassert>
#include <chrono>
#include <cstring>
#include <iterator>

namespace merlin {
namespace {

static_assert(std::endian::native == std::endian::little);  // ToPly copies the bytes of floats

// nav2_map_server's trinary mode: darker than occupied_thresh is occupied, lighter than free_thresh is free. 0.196 is
// just below the darkness of 205, (255 - 205) / 255 = 0.19608, so that unknown stays unknown.
constexpr int kOccupiedFromPercent = 65;
constexpr double kFreeBelow = 0.196;
constexpr int kFreeToPercent = 19;
constexpr char kFree = static_cast<char>(254), kOccupied = 0, kUnknown = static_cast<char>(205);

void AppendStamp(std::string& text, Time stamp) {
  const std::int64_t ns = stamp.count();
  const std::uint64_t magnitude = ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  fmt::format_to(std::back_inserter(text), "{}{}.{:09}", ns < 0 ? "-" : "", magnitude / 1000000000,
                 magnitude % 1000000000);
}

template <class Value>
void AppendBytes(std::string& bytes, const Value& value) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), &value, sizeof(Value));
  bytes.append(raw.data(), raw.size());
}

char Grey(std::int8_t cell) {
  if (cell >= kOccupiedFromPercent) return kOccupied;
  return cell >= 0 && cell <= kFreeToPercent ? kFree : kUnknown;
}

}  // namespace

std::string ToTum(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    Eigen::Quaterniond q = Eigen::Quaterniond(pose.T.linear()).normalized();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const Eigen::Vector3d p = pose.T.translation();
    AppendStamp(text, pose.stamp);
    fmt::format_to(std::back_inserter(text), " {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", p.x(), p.y(), p.z(),
                   q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

std::string ToPly(std::span<const MapPoint> map) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      map.size());
  bytes.reserve(bytes.size() + 15 * map.size());
  for (const MapPoint& point : map) {
    for (const float coordinate_m : {point.p_map.x(), point.p_map.y(), point.p_map.z()})
      AppendBytes(bytes, coordinate_m);
    for (const std::uint8_t value : point.rgb) AppendBytes(bytes, value);
  }
  return bytes;
}

std::string ToPgm(const GridMap& grid) {
  assert(grid.cells.size() == static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  std::string bytes = fmt::format("P5\n{} {}\n255\n", grid.width, grid.height);
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = 0; column < grid.width; ++column)
      bytes += Grey(grid.cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                               static_cast<std::size_t>(column)]);
  return bytes;
}

std::string ToMapYaml(const GridMap& grid, const std::string& pgm_name) {
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {}\norigin: [{:.6f}, {:.6f}, 0.0]\nnegate: 0\noccupied_thresh: {}\n"
      "free_thresh: {}\n",
      pgm_name, grid.resolution_m, grid.origin_m.x(), grid.origin_m.y(), kOccupiedFromPercent / 100.0, kFreeBelow);
}

}  // namespace merlin
