// The errors of a time-of-flight camera. Range wrap is not among them: it is the measuring principle.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace merlin::sim {

struct TofEffects {
  bool noise = true;          // shot noise of light and dark current, read noise of each tap
  bool adc = true;            // whole counts
  bool wiggling = true;       // harmonics 3 and 5 of the correlation
  bool saturation = true;     // a tap holds at most the full well
  bool sbi = true;            // a chip with SBI suppresses background light, which adds noise
  bool sunlight = true;       // sun, sky through windows, lamps
  bool intensity = true;      // dark surfaces read nearer: response of the chip, and a residual
  bool flying = true;         // a pixel sees an area: sub-rays
  bool motion = true;         // sub-frames are taken one after the other
  bool multipath = true;      // light that comes from another surface
  bool glass = true;          // panes transmit and mirror
  bool specular = true;       // mirrors, polished and retro-reflecting surfaces
  bool scatter = true;        // between lens and chip
  bool temperature = true;    // drift
  bool fixed_pattern = true;  // phase, gain and offset of each pixel
  bool dead_pixels = true;    // dead and hot ones
  bool lamp = true;           // two boards beside the lens, their lobe, vignetting

  // calibrated: as the factory delivers the camera: wiggling, fixed pattern and drift measured and subtracted as far as
  // possible, and warm. Otherwise raw: nothing subtracted, and cold at the start of the run.
  bool calibrated = true;
};

constexpr TofEffects kIdealTof{false, false, false, false, false, false, false, false, false,
                               false, false, false, false, false, false, false, false};

struct TofEffectName {
  std::string_view name;
  bool TofEffects::*on;
};
// Every effect that can be switched, in the order of its declaration.
std::span<const TofEffectName> TofEffectNames();

// "all", "raw" (all, without calibration), "ideal" (none), or names separated by commas, read from left to right:
// "noise,saturation" is these two, "-noise" is all but one. Throws InputError that suggests the nearest name.
TofEffects ParseTofEffects(const std::string& text);

}  // namespace merlin::sim
