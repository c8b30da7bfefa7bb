// Reads the description of the robot from models/: the car from URDF (urdfdom), the cameras from their data sheets
// (YAML).
#pragma once

#include <filesystem>

#include "robot/types/car.h"
#include "robot/types/depth_camera.h"
#include "robot/types/depth_camera_errors.h"
#include "robot/types/measurements.h"

namespace merlin {

// Reads any URDF of a car-like robot whose wheels, steering and sensors have the default names (wheel_front_left_joint,
// steer_front_left_joint, depth_camera_optical_frame, ...) or are named by a mapping file beside it: see
// robot/description/car_mapping.h. Meshes are found as ROS lays packages out: robot/description/mesh_path.h. A mesh
// with a negative scale is mirrored. Left and right may be up to 5 mm off symmetry; a warning of the description says
// so. Throws InputError, a line for each fault: file, line where the parser knows it, link or joint, and what is
// missing or wrong (a shape that URDF does not know, a missing mesh, a wheel or frame that the car needs, a
// non-positive mass or dimension): robot/description/urdf_check.h. No shape is left out.
CarDescription ReadCar(const std::filesystem::path& urdf);

// What a file describes, judged by its keys. kNone: a map without any key of a camera. kUnknown: the keys do not show
// it.
enum class CameraKind { kUnknown, kNone, kDepth, kColor };
CameraKind KindOfCamera(const std::filesystem::path& yaml);

// Throw InputError: unknown key (names the nearest), missing key, value out of range, values that contradict each
// other; all faults at once, of the sheet and of its errors alike. The camera's errors are read from the map under the
// key `errors`; omitted ones have their defaults.
DepthCameraSheet ReadDepthCameraSheet(const std::filesystem::path& yaml);
DepthCameraErrors ReadDepthCameraErrors(const std::filesystem::path& yaml);
ColorCameraSheet ReadColorCameraSheet(const std::filesystem::path& yaml);

}  // namespace merlin
