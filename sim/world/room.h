// Reads a room's MJCF file with MuJoCo, and turns MuJoCo's errors into InputError.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <string>

#include "robot/base/error.h"
#include "sim/world/spec.h"

namespace merlin::sim {

// After this call, and in the whole process, MuJoCo throws std::runtime_error on an error and prints and logs nothing.
void SilenceMujoco();

// The error for a room that MuJoCo rejects, with the line number if MuJoCo's message has one.
InputError RoomError(const std::filesystem::path& room, const std::string& what, const std::string& mujoco_message);

// Parses the room without compiling it. Geoms named "curtain*" are kept if the curtain is closed and removed if it is
// open, so that neither cameras nor sunlight meet them. Geoms listed in the custom text "leave_out" are removed as
// well: a room can include another one and replace a part of it. Silences MuJoCo. Throws InputError if the file is
// missing or not MJCF, if the curtain is to be closed and there is none, or if leave_out lists a geom that does not
// exist.
SpecPtr ReadRoom(const std::filesystem::path& room, bool curtain_closed);

// Compiles the room without the car and with its own compiler options. Geoms and bodies have the order of ReadRoom's
// spec; meshes get no convex hulls. Throws InputError like ReadRoom, and if the room does not compile, for example
// because it refers to parts of the car.
ModelPtr CompileAlone(const std::filesystem::path& room, bool curtain_closed);

// Removes from the room's spec what would change a car added to it: physics options, compiler options, sizes, and
// keyframes (which hold no state for the car). The room's moving bodies keep the masses and inertias that its compiler
// options gave them in alone.
void KeepFromCar(mjSpec* room, const mjModel* alone);

// The geom's name, for example "wall_north"; "geom 12" if it has none.
std::string GeomName(const mjModel* model, int geom);

// Whether a point lies in a sphere, capsule, cylinder, ellipsoid or box at its pose in data; false for other shapes.
bool IsInside(const mjModel* model, const mjData* data, int geom, const mjtNum point_world[3]);

}  // namespace merlin::sim
