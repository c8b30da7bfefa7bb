// How a colour sensor turns light into a picture: electrons, noise, gain, 8 bit. Model: EMVA Standard 1288, release 3.1
// (linear pixel, shot noise, one read noise), with natural vignetting before it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "robot/types/color_camera.h"

namespace merlin::sim {

// A rendered 8-bit value is taken as sRGB (IEC 61966-2-1): this is its linear light, white 1. A camera encodes its own
// pictures as sRGB too, so that a nominally exposed one looks as rendered.
double LinearOfSrgb(double value);  // value 0 to 255
double SrgbOfLinear(double light);  // light 0 to 1, not rounded

class ColorResponse {
 public:
  ColorResponse(const ColorCameraSheet& sheet, std::uint64_t seed);

  // In place, from a rendered picture as the lens forms it to what the camera delivers. Electrons of a pixel: full well
  // times linear light times exposure over nominal exposure times cos^falloff_power; shot noise of as many electrons
  // (Gaussian) and read noise; clipped at the full well; times gain and white balance; 4096 steps, clipped, coded in 8 bit.
  void Expose(std::span<std::uint8_t> bgr, const ColorSettings& settings, std::uint64_t frame) const;

 private:
  static constexpr int kChunk = 384;  // values dealt with at once: whole pixels, whole eights of random blocks
  struct Scale;
  Scale ScaleOf(const ColorSettings& settings) const;
  // first: index of the first value in the picture; deviate: normally distributed, by value.
  void ExposeChunk(std::span<std::uint8_t, kChunk> values, std::size_t first, const Scale& scale,
                   const std::array<float, kChunk>& deviate) const;

  ColorCameraSheet sheet_;
  std::uint64_t seed_;
  std::vector<float> falloff_;  // by value of a picture, and a chunk of zeros
};

// The automatic exposure: from the settings a picture was taken with and the picture, those of the next one. The mean
// linear light moves half the distance (in stops) to 0.18, a grey card, unless it is within a quarter stop; exposure time
// first, then gain.
ColorSettings NextExposure(const ColorCameraSheet& sheet, const ColorSettings& settings,
                           std::span<const std::uint8_t> bgr);

}  // namespace merlin::sim
