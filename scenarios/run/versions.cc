#include "scenarios/run/versions.h"

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

namespace merlin {

std::vector<std::pair<std::string, std::string>> Versions() {
  const auto dotted = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
  };
  return {
      {"merlin", MERLIN_VERSION},
      {"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"opencv", CV_VERSION},
      {"compiler", __VERSION__},
  };
}

}  // namespace merlin
