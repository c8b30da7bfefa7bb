// Normally distributed numbers for a row of pixels, many at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "robot/base/random.h"

namespace merlin::sim {

// Draws four numbers for each of count neighbouring pixels: mean 0, sigma 1, [number][pixel]; |value| < 6.8. A pure
// function of seed, sensor, frame, pixel, purpose and draw. Streams are those of Random for the same purpose, so use
// another purpose than Random.
class NormalRow {
 public:
  explicit NormalRow(std::size_t count) : count_(count) {
    for (std::vector<float>& row : of) row.resize((count + 7) / 8 * 8);
  }
  // draw: index of the four numbers within a pixel; first_pixel: of the row.
  void Draw(std::uint64_t seed, Sensor sensor, std::uint64_t frame, std::uint32_t first_pixel, std::uint16_t purpose,
            std::uint32_t draw);

  std::array<std::vector<float>, 4> of;

 private:
  std::size_t count_;
};

}  // namespace merlin::sim
