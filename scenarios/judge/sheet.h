// The sheet of paper a map is drawn on: a header, a plot of the world to scale, a footer.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

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

// Lengths are pixels of the finished picture, from its upper left corner; world x runs right, y up. Colours: blue,
// green, red.
class Sheet {
 public:
  static constexpr double kWidth_px = 1400.0;
  static constexpr double kMargin_px = 48.0;

  // Shows the box, with some space around it. It holds at least one point.
  explicit Sheet(const Box& box);

  double Height_px() const;
  double Metres_px(double length_m) const { return length_m * px_per_m_; }
  const Box& view() const { return view_; }  // what the plot shows
  bool Shows(const Eigen::Vector2d& p) const;
  Eigen::Vector2d Pixel(const Eigen::Vector2d& p) const;

  void Fill(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, const cv::Scalar& color);
  void Line(const std::vector<Eigen::Vector2d>& points_px, double width_px, const cv::Scalar& color,
            bool closed = false);
  void LineInWorld(const std::vector<Eigen::Vector2d>& points_m, double width_px, const cv::Scalar& color,
                   bool closed = false);
  void Dot(const Eigen::Vector2d& p_px, double radius_px, const cv::Scalar& color);
  // A point of a cloud: a square, quicker than a dot.
  void Speck(const Eigen::Vector2d& p_px, double edge_px, const cv::Scalar& color);
  // Text (ASCII) from its left end on its base line; size_px: height of capitals.
  void Text(const Eigen::Vector2d& p_px, const std::string& text, double size_px, const cv::Scalar& color,
            bool bold = false);
  double TextWidth_px(const std::string& text, double size_px) const;

  // 8-bit BGR.
  cv::Mat Finished() const;

 private:
  double plot_height_px_ = 0.0;
  double px_per_m_ = 1.0;
  Box view_;
  cv::Mat image_;
};

}  // namespace merlin
