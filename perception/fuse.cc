#include "perception/fuse.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace merlin {
namespace {

constexpr float kNearest_m = 0.05f;
constexpr float kCellsPerPoint = 4.0f;  // the depth buffer's cells along the side of a point's square
constexpr float kSide = 1.1f;           // of that square, in spacings: a little more than 1, so surfaces have no holes

struct Projected {
  float u_px = 0.0f, v_px = 0.0f, depth_m = 0.0f;
  bool in_picture = false;
};

// The nearest depth in each cell of the picture.
class DepthBuffer {
 public:
  DepthBuffer(const ColorFrame& frame, float spacing_px)
      : cell_px_(std::max(1.0f, spacing_px / kCellsPerPoint)),
        reach_(kSide * spacing_px / (2.0f * cell_px_)),
        columns_(static_cast<int>(static_cast<float>(frame.width) / cell_px_) + 1),
        rows_(static_cast<int>(static_cast<float>(frame.height) / cell_px_) + 1),
        nearest_m_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), HUGE_VALF) {}

  void Cover(const Projected& point) {
    const float column = Cell(point.u_px), row = Cell(point.v_px);
    const int left = std::max(0, static_cast<int>(std::lround(column - reach_)));
    const int right = std::min(columns_ - 1, static_cast<int>(std::lround(column + reach_)) - 1);
    const int bottom = std::min(rows_ - 1, static_cast<int>(std::lround(row + reach_)) - 1);
    for (int r = std::max(0, static_cast<int>(std::lround(row - reach_))); r <= bottom; ++r)
      for (int c = left; c <= right; ++c) At(c, r) = std::min(At(c, r), point.depth_m);
  }
  bool Hides(const Projected& point) {
    return At(static_cast<int>(Cell(point.u_px)), static_cast<int>(Cell(point.v_px))) < 0.97f * point.depth_m - 0.05f;
  }

 private:
  float Cell(float px) const { return (px + 0.5f) / cell_px_; }
  float& At(int column, int row) {
    return nearest_m_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(column)];
  }

  float cell_px_, reach_;
  int columns_, rows_;
  std::vector<float> nearest_m_;
};

Projected Project(const Point& point, const ColorFrame& frame, const CameraModel& camera, const Pose& T_color_base) {
  const Eigen::Vector3d p_color = T_color_base * point.position.cast<double>();
  if (!(p_color.z() > kNearest_m)) return {};
  const Eigen::Vector2f pixel = camera.Project(p_color).cast<float>();
  const float right_px = static_cast<float>(frame.width) - 0.5f, bottom_px = static_cast<float>(frame.height) - 0.5f;
  const bool in_picture = pixel.x() > -0.5f && pixel.x() < right_px && pixel.y() > -0.5f && pixel.y() < bottom_px;
  return {pixel.x(), pixel.y(), static_cast<float>(p_color.z()), in_picture};
}

}  // namespace

void ColorPoints(std::span<Point> points_base, const ColorFrame& frame, const CameraModel& camera,
                 const Pose& T_color_base, double pixel_rad) {
  DepthBuffer buffer(frame, static_cast<float>(camera.fx_px * pixel_rad));
  std::vector<Projected> projected;
  projected.reserve(points_base.size());
  for (const Point& point : points_base) {
    projected.push_back(Project(point, frame, camera, T_color_base));
    if (projected.back().in_picture) buffer.Cover(projected.back());
  }
  for (std::size_t i = 0; i < points_base.size(); ++i) {
    if (!projected[i].in_picture || buffer.Hides(projected[i])) continue;
    const auto u = static_cast<std::size_t>(std::lround(projected[i].u_px));
    const auto v = static_cast<std::size_t>(std::lround(projected[i].v_px));
    const std::uint8_t* bgr = &frame.bgr[3 * (v * static_cast<std::size_t>(frame.width) + u)];
    points_base[i].bgr = {bgr[0], bgr[1], bgr[2]};
    points_base[i].has_color = true;
  }
}

}  // namespace merlin
