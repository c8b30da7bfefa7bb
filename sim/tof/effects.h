// Which errors a time-of-flight camera makes. Range wrap is none of them: it is the measuring principle.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace merlin::sim {

struct TofEffects {
  bool noise = true;          // shot noise of light and dark current, read noise of each tap
  bool adc = true;            // whole counts
  bool wiggling = true;       // harmonics 3 and 5 of the correlation
  bool saturation = true;     // a tap ends at the full well
  bool sbi = true;            // a chip that can suppress background light does, and pays with noise
  bool sunlight = true;       // sun, sky through windows, lamps
  bool intensity = true;      // dark surfaces read nearer: response, and what it does not explain
  bool flying = true;         // a pixel sees an area: sub-rays
  bool motion = true;         // sub-frames are taken one after the other
  bool multipath = true;      // light that comes from another surface
  bool glass = true;          // panes let through and mirror
  bool specular = true;       // mirrors, polished and retro-reflecting surfaces
  bool scatter = true;        // between lens and chip
  bool temperature = true;    // drift
  bool fixed_pattern = true;  // phase, gain and offset of each pixel
  bool dead_pixels = true;    // dead and hot ones
  bool lamp = true;           // two boards beside the lens, their lobe, vignetting

  // As a factory leaves the camera: wiggling, fixed pattern and drift measured and taken off as far as that goes, and
  // warm. Else raw: nothing taken off, and cold at the start of the run.
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

// "all", "raw" (all, and not calibrated), "ideal" (none), or names with commas, read from left to right:
// "noise,saturation" is these two, "-noise" all but one. Throws InputError naming the nearest.
TofEffects ParseTofEffects(const std::string& text);

}  // namespace merlin::sim
