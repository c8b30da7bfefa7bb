// A figure with curves: measured samples as dots, and what a law predicts as lines.
#pragma once

#include <string>
#include <vector>

#include "tools/camera/scale.h"

namespace merlin {

struct Series {
  std::string name{};
  bool dots = false;             // false: a line, interrupted where a value is NaN
  int color = 0;                 // index; series with the same index belong together
  std::vector<double> x{}, y{};  // equally long

  void Add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

struct Panel {
  Axis x{}, y{};
  std::vector<Series> series{};
};

struct Figure {
  std::string title{}, subtitle{};  // ASCII
  std::vector<Panel> panels{};      // from top to bottom
};

std::string ToPng(const Figure& figure);
// One line per point: panel,series,kind,x,y. Comment lines give the labels of the axes.
std::string ToCsv(const Figure& figure);

}  // namespace merlin
