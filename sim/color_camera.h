// The colour camera: MuJoCo's picture, then photon and read noise, 8 bit. Its lens has no distortion yet.
#pragma once

#include <cstdint>
#include <vector>

#include "robot/types/measurements.h"
#include "sim/renderer.h"

namespace merlin::sim {

// Adds noise in place: variance of a value v is v * gain + read_noise^2 (8-bit counts), rounded and clipped to 0..255.
void AddColorNoise(std::vector<std::uint8_t>& bgr, const ColorCameraSheet& sheet, std::uint64_t seed,
                   std::uint64_t frame);

}  // namespace merlin::sim
