#include "perception/fuse.h"

#include <cmath>

namespace merlin {

void ColorPoints(std::span<Point> points_base, const ColorFrame& frame, const CameraModel& camera, const Pose& T_color_base) {
  for (Point& point : points_base) {
    const Eigen::Vector3d p_color = T_color_base * point.position.cast<double>();
    if (p_color.z() <= 0.05) continue;
    const Eigen::Vector2d pixel = camera.Project(p_color);
    const long u = std::lround(pixel.x());
    const long v = std::lround(pixel.y());
    if (u < 0 || u >= frame.width || v < 0 || v >= frame.height) continue;
    const std::uint8_t* bgr = &frame.bgr[3 * (static_cast<std::size_t>(v) * frame.width + u)];
    point.bgr = {bgr[0], bgr[1], bgr[2]};
    point.has_color = true;
  }
}

}  // namespace merlin
