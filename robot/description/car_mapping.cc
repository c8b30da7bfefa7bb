#include "robot/description/car_mapping.h"

namespace merlin {

CarMapping NamingRule() {
  const auto rule = [](const char* name) { return RoleName{name, name, ""}; };
  return {{rule("wheel_front_left_joint"), rule("wheel_front_right_joint"), rule("wheel_rear_left_joint"),
           rule("wheel_rear_right_joint")},
          {rule("steer_front_left_joint"), rule("steer_front_right_joint")},
          rule("depth_camera_optical_frame"),
          rule("color_camera_optical_frame"),
          rule("compass_frame")};
}

}  // namespace merlin
