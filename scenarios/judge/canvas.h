// A white canvas for figures, in pixels from its upper left corner. It is drawn larger and averaged down.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace merlin {

enum class TextAlign { kLeft, kMiddle, kRight };

inline const cv::Scalar kInk(45, 40, 38);  // colour of text and axes; blue, green, red

class Canvas {
 public:
  Canvas(int width_px, int height_px);

  // Colours: blue, green, red.
  void Fill(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, const cv::Scalar& color);
  void Line(const std::vector<Eigen::Vector2d>& points_px, double width_px, const cv::Scalar& color,
            bool closed = false);
  void Dot(const Eigen::Vector2d& p_px, double radius_px, const cv::Scalar& color);
  // A point of a cloud, drawn as a square, which is faster than a dot.
  void Speck(const Eigen::Vector2d& p_px, double edge_px, const cv::Scalar& color);
  // ASCII text; p_px is on its base line. size_px: height of capitals.
  void Text(const Eigen::Vector2d& p_px, const std::string& text, double size_px, const cv::Scalar& color,
            TextAlign align = TextAlign::kLeft, bool bold = false);
  static double TextWidth_px(const std::string& text, double size_px);  // of text that is not bold
  // An 8-bit BGR picture, each of its pixels drawn as a square with edges of scale pixels.
  void Picture(const Eigen::Vector2d& corner_px, const cv::Mat& bgr, int scale);

  std::string ToPng() const;  // throws MachineError

 private:
  cv::Mat image_;
};

}  // namespace merlin
