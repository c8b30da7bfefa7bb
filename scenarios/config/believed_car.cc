#include "scenarios/config/believed_car.h"

#include <fmt/format.h>

#include "robot/base/error.h"
#include "robot/description/description.h"
#include "scenarios/config/calibration.h"
#include "scenarios/config/names.h"

namespace merlin {

CarDescription BelievedCar(const CarChoice& choice) {
  const CarDescription car = ReadCar(CarFile(choice.model));
  return choice.calibration.empty() ? car : Calibrated(car, ReadCalibration(choice.calibration));
}

void LeaveOutWhatTheCarLacks(const CarDescription& car, Sensors& sensors, std::vector<std::string>& warnings) {
  const std::string lacks = fmt::format("the car '{}' has no ", car.name);
  if (sensors.color && !car.T_base_color) {
    if (sensors.color->required)
      throw InputError("sensors.color.required", lacks + "colour camera",
                       "false, or a car whose mapping names a color_camera_frame");
    sensors.color.reset();
    warnings.push_back("depth only: " + lacks + "colour camera");
  }
  if (sensors.compass && !car.T_base_compass) {
    sensors.compass.reset();
    warnings.push_back("without headings: " + lacks + "compass");
  }
}

}  // namespace merlin
