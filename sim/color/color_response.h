// Model of a colour sensor, from light to an 8-bit picture: electrons, noise, gain, coding. It follows EMVA Standard
// 1288, release 3.1 (linear pixel, shot noise, one read noise), and adds natural vignetting of the lens.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "robot/types/color_camera.h"

namespace merlin::sim {

// Conversion between 8-bit sRGB values (IEC 61966-2-1) and linear light, where white is 1. Rendered pictures are taken
// as sRGB, and the camera encodes its pictures as sRGB, so that a picture of nominal exposure looks as rendered.
double LinearOfSrgb(double value);  // value 0 to 255
double SrgbOfLinear(double light);  // light 0 to 1, not rounded

class ColorResponse {
 public:
  ColorResponse(const ColorCameraSheet& sheet, std::uint64_t seed);

  // Turns, in place, the picture on the sensor into the one that the camera delivers:
  //   electrons = full well * linear light * exposure / nominal exposure * cos^falloff_power
  //   plus Gaussian shot noise and read noise, clipped at the full well,
  //   times gain and white balance, quantised to 4096 steps, clipped, and encoded in 8 bits.
  void Expose(std::span<std::uint8_t> bgr, const ColorSettings& settings, std::uint64_t frame) const;

 private:
  static constexpr int kChunk = 384;  // values processed at once: a multiple of 3 (pixels) and of 64 (random numbers)
  struct Scale;
  Scale ScaleOf(const ColorSettings& settings) const;
  // first: index of the first value in the picture; deviate: normally distributed, by value.
  void ExposeChunk(std::span<std::uint8_t, kChunk> values, std::size_t first, const Scale& scale,
                   const std::array<float, kChunk>& deviate) const;

  ColorCameraSheet sheet_;
  std::uint64_t seed_;
  std::vector<float> falloff_;  // for each value of a picture, padded with a chunk of zeros
};

// Automatic exposure: the settings for the next picture, given the last one and its settings. They move the mean linear
// light half the distance, in stops, towards 0.18 (a grey card), and do not change within a quarter stop of it. The
// exposure time is changed first, then the gain.
ColorSettings NextExposure(const ColorCameraSheet& sheet, const ColorSettings& settings,
                           std::span<const std::uint8_t> bgr);

}  // namespace merlin::sim
