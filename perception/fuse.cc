#include "perception/fuse.h"

#include <cmath>

namespace merlin {

void ColorPoints(std::span<Point> points_base, const ColorFrame& frame, const CameraModel& camera, const Pose& T_color_base) {
  for (Point& point : points_base) {
    const Eigen::Vector3d p_color = T_color_base * point.position.cast<double>();
    if (p_color.z() <= 0.05) continue;
    const Eigen::Vector2d pixel = camera.Project(p_color);
    const bool seen = pixel.x() > -0.5 && pixel.x() < frame.width - 0.5 && pixel.y() > -0.5 && pixel.y() < frame.height - 0.5;
    if (!seen) continue;
    const auto u = static_cast<std::size_t>(std::lround(pixel.x())), v = static_cast<std::size_t>(std::lround(pixel.y()));
    const std::uint8_t* bgr = &frame.bgr[3 * (v * static_cast<std::size_t>(frame.width) + u)];
    point.bgr = {bgr[0], bgr[1], bgr[2]};
    point.has_color = true;
  }
}

}  // namespace merlin
