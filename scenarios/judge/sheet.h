// A canvas for maps: a plot of the world, to scale, between a header and a footer.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "scenarios/judge/canvas.h"

namespace merlin {

// A rectangle in the world [m]; empty until a point is added.
struct Box {
  Eigen::Vector2d min{HUGE_VAL, HUGE_VAL};
  Eigen::Vector2d max{-HUGE_VAL, -HUGE_VAL};

  void Add(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

// Pixels are those of the canvas; world x runs right, y up.
class Sheet {
 public:
  static constexpr double kWidth_px = 1400.0;
  static constexpr double kMargin_px = 48.0;

  // Shows the box, which must hold at least one point, with some space around it.
  explicit Sheet(const Box& box);

  double Height_px() const;
  double Metres_px(double length_m) const { return length_m * px_per_m_; }
  const Box& view() const { return view_; }  // what the plot shows
  bool Shows(const Eigen::Vector2d& p) const;
  Eigen::Vector2d Pixel(const Eigen::Vector2d& p) const;

  void LineInWorld(const std::vector<Eigen::Vector2d>& points_m, double width_px, const cv::Scalar& color,
                   bool closed = false);
  Canvas& canvas() { return canvas_; }

 private:
  double plot_height_px_;
  double px_per_m_ = 1.0;
  Box view_;
  Canvas canvas_;
};

}  // namespace merlin
