#include "slam/saved_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <span>
#include <type_traits>

#include "robot/base/error.h"
#include "robot/base/files.h"
#include "robot/base/sha256.h"

namespace merlin {
namespace {

static_assert(std::endian::native == std::endian::little);  // numbers are copied as they are

constexpr std::string_view kMagic = "map.slam";
constexpr std::size_t kDigits = 64;  // of SHA-256
constexpr std::size_t kHeader = kMagic.size() + sizeof(std::uint32_t) + sizeof(std::uint64_t) + kDigits;
constexpr char kWhat[] = "a map of an earlier run (map.slam)";

template <class T>
concept Number = std::is_arithmetic_v<T>;
template <class T, class Wanted>
concept Is = std::same_as<std::remove_const_t<T>, Wanted>;

// The content, one list for writing and reading: visit(field) in the order of the file.
template <class Visitor>
void Fields(Visitor& visit, Is<Point> auto& point) {
  visit(point.position), visit(point.sigma_m), visit(point.bgr), visit(point.has_color);
}
template <class Visitor>
void Fields(Visitor& visit, Is<ClearView> auto& view) {
  ClearView::VisitFields(visit, view);
}
template <class Visitor>
void Fields(Visitor& visit, Is<PlacedView> auto& placed) {
  visit(placed.stamp), visit(placed.T_keyframe_base), visit(placed.view);
}
template <class Visitor>
void Fields(Visitor& visit, Is<Keyframe> auto& keyframe) {
  visit(keyframe.stamp), visit(keyframe.T_map_base), visit(keyframe.T_previous_base), visit(keyframe.first_of_run);
  visit(keyframe.path_m), visit(keyframe.in_local_map_m), visit(keyframe.yaw_rad), visit(keyframe.yaw_sigma_rad);
  visit(keyframe.view_yaw_rad), visit(keyframe.camera_base), visit(keyframe.points_base), visit(keyframe.views);
}
template <class Visitor>
void Fields(Visitor& visit, Is<GraphEdge> auto& edge) {
  visit(edge.from), visit(edge.to), visit(edge.T_from_to), visit(edge.information), visit(edge.robust);
}
template <class Visitor>
void Fields(Visitor& visit, Is<SavedMap> auto& map) {
  visit(map.heading_turn_rad), visit(map.keyframes), visit(map.loops);
}

class MapWriter {
 public:
  explicit MapWriter(std::string& bytes) : bytes_(bytes) {}

  void operator()(const Number auto& value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(value)>>(value);
    bytes_.append(raw.data(), raw.size());
  }
  void operator()(const Time& time) { (*this)(time.count()); }
  void operator()(const Pose& pose) { (*this)(Eigen::Matrix<double, 3, 4>(pose.affine())); }
  template <class Scalar, int Rows, int Columns>
  void operator()(const Eigen::Matrix<Scalar, Rows, Columns>& matrix) {
    for (const Scalar value : std::span(matrix.data(), Rows * Columns)) (*this)(value);
  }
  void operator()(const std::array<std::uint8_t, 3>& values) {
    for (const std::uint8_t value : values) (*this)(value);
  }
  void operator()(const std::optional<double>& value) { (*this)(value.has_value()), (*this)(value.value_or(0.0)); }
  template <class Value>
  void operator()(const std::vector<Value>& values) {
    (*this)(std::uint64_t{values.size()});
    for (const Value& value : values) (*this)(value);
  }
  template <class Struct>
  void operator()(const Struct& fields) {
    Fields(*this, fields);
  }

 private:
  std::string& bytes_;
};

// Reads zeros, and is no longer whole, where the bytes end or say what cannot be.
class MapReader {
 public:
  explicit MapReader(std::string_view bytes) : rest_(bytes) {}

  bool whole() const { return whole_; }
  bool at_end() const { return rest_.empty(); }

  void operator()(Number auto& value) {
    value = {};
    if (rest_.size() < sizeof value) return Fail();
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
  }
  void operator()(bool& value) {
    std::uint8_t byte = 0;
    (*this)(byte);
    if (byte > 1) Fail();
    value = byte == 1;
  }
  void operator()(Time& time) {
    Time::rep count = 0;
    (*this)(count);
    time = Time(count);
  }
  void operator()(Pose& pose) {
    Eigen::Matrix<double, 3, 4> matrix;
    (*this)(matrix);
    pose.affine() = matrix;
  }
  template <class Scalar, int Rows, int Columns>
  void operator()(Eigen::Matrix<Scalar, Rows, Columns>& matrix) {
    for (Scalar& value : std::span(matrix.data(), Rows * Columns)) (*this)(value);
  }
  void operator()(std::array<std::uint8_t, 3>& values) {
    for (std::uint8_t& value : values) (*this)(value);
  }
  void operator()(std::optional<double>& value) {
    bool has_value = false;
    (*this)(has_value), (*this)(value.emplace());
    if (has_value) return;
    if (std::bit_cast<std::uint64_t>(*value) != 0) Fail();
    value.reset();
  }
  // What is reserved is no more than what the rest can hold, whatever the count says.
  template <class Value>
  void operator()(std::vector<Value>& values) {
    std::uint64_t count = 0;
    (*this)(count);
    if (count > rest_.size()) return Fail();  // a value takes a byte at least
    values.reserve(std::min<std::uint64_t>(count, rest_.size() / sizeof(Value)));
    for (; count > 0 && whole_; --count) (*this)(values.emplace_back());
  }
  template <class Struct>
  void operator()(Struct& fields) {
    Fields(*this, fields);
  }

 private:
  void Fail() { whole_ = false, rest_ = {}; }

  std::string_view rest_;
  bool whole_ = true;
};

bool IsPose(const Pose& pose) {
  const Eigen::Matrix3d R = pose.linear();
  return pose.affine().allFinite() && (R * R.transpose()).isIdentity(1e-6) && R.determinant() > 0.0;
}

// What the rest of the program takes for granted. Points may be anything, as those of an observation.
bool IsSound(const Keyframe& keyframe) {
  return IsPose(keyframe.T_map_base) && IsPose(keyframe.T_previous_base) && std::isfinite(keyframe.path_m) &&
         std::isfinite(keyframe.in_local_map_m) && std::isfinite(keyframe.yaw_rad.value_or(0.0)) &&
         keyframe.yaw_sigma_rad >= 0.0 && std::isfinite(keyframe.view_yaw_rad) && keyframe.camera_base.allFinite() &&
         std::ranges::all_of(keyframe.views, [](const PlacedView& placed) {
           return IsPose(placed.T_keyframe_base) && placed.view.IsWhole();
         });
}

bool IsSound(const SavedMap& map) {
  const std::size_t count = map.keyframes.size();
  return std::isfinite(map.heading_turn_rad.value_or(0.0)) &&
         std::ranges::all_of(map.keyframes, [](const Keyframe& keyframe) { return IsSound(keyframe); }) &&
         std::ranges::is_sorted(map.keyframes, {}, &Keyframe::path_m) &&
         std::ranges::all_of(map.loops, [=](const GraphEdge& edge) {
           return edge.from < count && edge.to < count && edge.from != edge.to && IsPose(edge.T_from_to) &&
                  edge.information.allFinite();
         });
}

std::string HashOfContent(std::string_view content) {
  Sha256 hash;
  hash.Add(content);
  return hash.Hex();
}

std::string_view ContentOf(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with(kMagic)) throw InputError(name, "is not a map", kWhat);
  MapReader header(bytes.substr(kMagic.size()));
  std::uint32_t version = 0;
  std::uint64_t size = 0;
  header(version);
  if (header.whole() && version != SavedMap::kVersion)
    throw InputError(name, "a map of another version of the program", "version " + std::to_string(SavedMap::kVersion),
                     "version " + std::to_string(version));
  header(size);
  if (bytes.size() < kHeader || bytes.size() - kHeader != size)
    throw InputError(name, "a damaged map",
                     bytes.size() < kHeader ? "a header of " + std::to_string(kHeader) + " bytes"
                                            : std::to_string(size) + " bytes after the header",
                     std::to_string(bytes.size() < kHeader ? bytes.size() : bytes.size() - kHeader));
  const std::string_view content = bytes.substr(kHeader);
  if (HashOfContent(content) != bytes.substr(kHeader - kDigits, kDigits))
    throw InputError(name, "a damaged map: its bytes do not give the checksum in its header");
  return content;
}

}  // namespace

std::string ToBytes(const SavedMap& map) {
  std::string content, bytes(kMagic);
  MapWriter write(content);
  write(map);
  MapWriter header(bytes);
  header(SavedMap::kVersion), header(std::uint64_t{content.size()});
  return bytes + HashOfContent(content) + content;
}

SavedMap ParseSavedMap(std::string_view bytes, const std::string& name) {
  MapReader read(ContentOf(bytes, name));
  SavedMap map;
  read(map);
  if (!read.whole() || !read.at_end() || !IsSound(map))
    throw InputError(name, "a damaged map: the checksum is right, but the content is not that of a map");
  if (map.keyframes.empty()) throw InputError(name, "a map without key frames: it shows no place");
  return map;
}

SavedMap ReadSavedMap(const std::filesystem::path& file) { return ParseSavedMap(ReadFile(file, kWhat), file.string()); }

}  // namespace merlin
