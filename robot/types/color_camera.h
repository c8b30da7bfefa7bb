// What a colour camera is and what it delivers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot/types/camera_model.h"
#include "robot/types/time.h"

namespace merlin {

struct ColorSettings {
  double exposure_s = 0.0;         // with auto_exposure: of the first picture; valid: the sheet's range
  double gain = 1.0;               // of the amplifier before the converter; 1 to the sheet's gain_max
  bool auto_exposure = true;       // the camera sets exposure and gain, from picture to picture
  double white_balance_red = 1.0;  // factors of red and blue relative to green, 0.25 to 4
  double white_balance_blue = 1.0;

  bool operator==(const ColorSettings&) const = default;
};

// The data sheet of one model of camera. models/cameras/<name>.yaml has the values and their origin.
struct ColorCameraSheet {
  std::string name;
  CameraModel camera{};
  double rate_max_hz = 0.0;
  double latency_s = 0.0;      // from mid-exposure to the stack
  double full_well_e = 0.0;    // electrons at which a pixel clips; white (255) at gain 1
  double read_noise_e = 0.0;   // one sigma
  double falloff_power = 0.0;  // illumination falls off with cos^power of the angle to the axis; 4: natural vignetting
  double exposure_nominal_s = 0.0;  // correct exposure of a normally lit room at gain 1
  double exposure_min_s = 0.0;
  double exposure_max_s = 0.0;
  double gain_max = 1.0;
};

// The settings at power-up: nominal exposure, then automatic.
inline ColorSettings DefaultSettings(const ColorCameraSheet& sheet) { return {.exposure_s = sheet.exposure_nominal_s}; }

// Throws InputError for settings outside the sheet's ranges.
void CheckSettings(const ColorCameraSheet& sheet, const ColorSettings& settings);

// 8-bit BGR, row-major, three bytes a pixel, as OpenCV has it.
struct ColorFrame {
  Time stamp{0};  // middle of the exposure
  std::uint64_t index = 0;
  ColorSettings settings;  // as used: with auto_exposure, exposure and gain are those the camera chose
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bgr;
};

}  // namespace merlin
