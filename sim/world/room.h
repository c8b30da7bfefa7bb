// Reads a room's MJCF with MuJoCo, and turns MuJoCo's errors into ours.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <string>

#include "robot/base/error.h"
#include "sim/world/spec.h"

namespace merlin::sim {

// From here on errors of MuJoCo itself throw std::runtime_error, in the whole process; it prints and logs nothing.
void SilenceMujoco();

// The error of a room that MuJoCo refuses, with its line where MuJoCo's message knows it.
InputError RoomError(const std::filesystem::path& room, const std::string& what, const std::string& mujoco_message);

// Parsed, not compiled. Geoms named "curtain*" stay where the room has them, or are taken out: an open curtain stops
// neither camera nor sun. Geoms that the text "leave_out" names are taken out: so a room can include another one and change
// a part of it. Silences MuJoCo. Throws InputError: no such file, no MJCF, a curtain to close where there is none, a geom to
// leave out that is not there.
SpecPtr ReadRoom(const std::filesystem::path& room, bool curtain_closed);

// The room compiled for itself, as its own compiler options say, with geoms and bodies in the order of ReadRoom's spec; its
// meshes get no convex hulls. Throws InputError as ReadRoom does, and where the room does not compile: also where it names
// what it does not have, such as parts of the car.
ModelPtr CompileAlone(const std::filesystem::path& room, bool curtain_closed);

// Takes out of the spec what would reach a car that is added to it: physics options, compiler options (the room's moving
// bodies keep the masses and inertias that these gave them in alone), sizes, keyframes (which have no place for the
// car).
void KeepFromCar(mjSpec* room, const mjModel* alone);

// "wall_north", or "geom 12" for one without a name.
std::string GeomName(const mjModel* model, int geom);

// Whether a point lies in a sphere, capsule, cylinder, ellipsoid or box, standing where data has it; false for others.
bool IsInside(const mjModel* model, const mjData* data, int geom, const mjtNum point_world[3]);

}  // namespace merlin::sim
