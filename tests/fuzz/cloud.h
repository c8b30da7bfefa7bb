// What every reader of a cloud keeps: a file is refused in one sentence or taken whole, and never more of it than is
// there.
#pragma once

#include <string>

#include "tests/fuzz/text.h"
#include "tools/cloud/cloud_file.h"

namespace merlin::fuzz {

// more: what behind a sound file makes it one that is refused.
inline void CheckCloud(CloudFile (*parse)(std::string_view, const std::string&), std::string_view text,
                       std::string_view more) {
  const auto file = TakenOrRefused(parse, text);
  if (!file) return;
  const Cloud& cloud = file->cloud;
  Expect(cloud.size() + file->left_out <= text.size(), "a point takes a byte at least");
  Expect(cloud.sigma_m.empty() || cloud.sigma_m.size() == cloud.size(), "a sigma a point");
  Expect(file->rgb.empty() || file->rgb.size() == cloud.size(), "a colour a point");
  for (const Eigen::Vector3d& position : cloud.positions) Expect(position.allFinite(), "points are finite");
  for (const double sigma_m : cloud.sigma_m) Expect(sigma_m > 0.0, "sigmas are above 0");
  Expect(!TakenOrRefused(parse, std::string(text) + std::string(more)), "more than the file says is refused");
}

}  // namespace merlin::fuzz
