#include "robot/types/color_camera.h"

#include "robot/base/error.h"
#include "robot/base/text_fields.h"

namespace merlin {
namespace {

void RequireWithin(const ColorCameraSheet& sheet, const std::string& what, const std::string& unit, double value,
                   double min, double max) {
  if (!(value >= min && value <= max))
    throw InputError(sheet.name, "invalid " + what, NumberText(min) + " to " + NumberText(max) + unit,
                     NumberText(value) + unit);
}

}  // namespace

void CheckSettings(const ColorCameraSheet& sheet, const ColorSettings& settings) {
  RequireWithin(sheet, "exposure time", " ms", 1e3 * settings.exposure_s, 1e3 * sheet.exposure_min_s,
                1e3 * sheet.exposure_max_s);
  RequireWithin(sheet, "gain", "", settings.gain, 1.0, sheet.gain_max);
  RequireWithin(sheet, "white balance of red", "", settings.white_balance_red, 0.25, 4.0);
  RequireWithin(sheet, "white balance of blue", "", settings.white_balance_blue, 0.25, 4.0);
}

}  // namespace merlin
