// Rules for every reader of a cloud: it rejects a file, with one sentence for each fault, or it takes all of it, and
// never more than the file has.
#pragma once

#include <string>

#include "tests/fuzz/text.h"
#include "tools/cloud/cloud_file.h"

namespace merlin::fuzz {

// more: bytes that, appended to a valid file, make it invalid, or valid with a warning.
inline constexpr std::size_t kPacked = 88;  // most bytes that LZF can make of one
inline void CheckCloud(CloudFile (*parse)(std::string_view, const std::string&), std::string_view text,
                       std::string_view more) {
  const auto file = TakenOrRefused(parse, text);
  if (!file) return;
  const Cloud& cloud = file->cloud;
  Expect(cloud.size() + file->left_out <= kPacked * text.size(), "a point takes a byte at least, if not packed");
  Expect(cloud.sigma_m.empty() || cloud.sigma_m.size() == cloud.size(), "a sigma a point");
  Expect(file->rgb.empty() || file->rgb.size() == cloud.size(), "a colour a point");
  for (const Eigen::Vector3d& position : cloud.positions) Expect(position.allFinite(), "points are finite");
  for (const double sigma_m : cloud.sigma_m) Expect(sigma_m > 0.0, "sigmas are above 0");
  const auto again = TakenOrRefused(parse, std::string(text) + std::string(more));
  Expect(!again || (again->cloud.size() == cloud.size() && !again->warnings.empty()),
         "more than the file says is refused or named");
}

}  // namespace merlin::fuzz
