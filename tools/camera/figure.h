// Curves for a person: samples as dots over lines that were computed another way.
#pragma once

#include <string>
#include <vector>

#include "tools/camera/scale.h"

namespace merlin {

struct Series {
  std::string name{};
  bool dots = false;             // else a line; NaN breaks it
  int color = 0;                 // series of one colour belong together
  std::vector<double> x{}, y{};  // of one length

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
  std::vector<Panel> panels{};      // from above
};

std::string ToPng(const Figure& figure);
// One line a point: panel,series,kind,x,y, with the axes' labels in comment lines.
std::string ToCsv(const Figure& figure);

}  // namespace merlin
