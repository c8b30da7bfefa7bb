// Decides which geoms of a room the car can touch, and in what shape. The rule: the car touches everything that its
// cameras see, in the shape that they see. Friction and stiffness of such a contact are those of the car alone.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "sim/world/materials.h"

namespace merlin::sim {

// Contact bits. A geom that the car can touch gets kMeetsCar added to its contype. The car's shapes have kMeetsCar as
// conaffinity and kCarItself as contype, so they never touch each other. The room's own bits are kept: they decide
// which parts of the room touch each other.
constexpr int kMeetsCar = 1 << 30, kCarItself = 1 << 29;

// Contact priority of the car's shapes. Geoms of the room get a lower one. In MuJoCo the geom of the higher priority
// alone sets friction, condim, solref and solimp of a contact, so the values in the room's file have no effect.
constexpr int kCarPriority = 1 << 20;

// Rooms often pair a detailed visual geom with simple colliding geoms, which stand in for it: every point of the visual
// surface is inside one of them, or no farther from it than
constexpr double kStandsFor_m = 0.05;        // if they belong to different bodies, or both to the world
constexpr double kStandsForInBody_m = 0.10;  // if they belong to one body, and so were made for each other
constexpr double kFloorStandsFor_m = 0.02;   // if it is a floor* or an infinite plane: covers a mat but not a kerb

// Marks or replaces the geoms that the car can touch. alone: the room compiled without the car (CompileAlone in
// sim/world/room.h), its geoms in the spec's order. A geom "collides" if its contype or conaffinity is not 0; it is
// "seen" if the cameras see it (IsSeen in sim/world/shape.h).
//
// - A geom that collides and is seen, or is named floor*, touches the car. An invisible colliding geom touches the car
//   if it shares a bit with MuJoCo's default ones, or if it stands in for a geom that is seen.
// - A geom that is seen but does not collide touches the car as well, unless its material is passable or colliding
//   geoms stand in for it: all points of its surface (a grid of 2.5 cm) are within the distances above. Geoms that move
//   relative to it cannot stand in for it. A passable geom that collides keeps the contacts that its bits give it.
// - Margins, gaps, adhesion and surface velocities of all that touches the car are set to 0, with a warning for a
//   surface velocity.
// - A mesh that is not convex (sim/world/mesh_pieces.h) collides as its convex pieces, a panel (sim/world/shape.h) as a
//   slab of thickness kSlab_m. They are invisible geoms "NAME#1", "NAME#2", ... of the same body, which take over the
//   contact bits. A colliding mesh of more than kPiecesMax pieces collides as its convex hull, with a warning.
// - A piece of a mesh that lies on a floor is left out, because the floor stands in for it: the mesh of a whole room
//   may include its own floor.
//
// Throws InputError with the names of all geoms that are seen, do not collide and cannot be made solid: meshes of too
// many pieces.
struct SolidRoom {
  std::vector<std::string> warnings{};  // one sentence each
  std::vector<mjsGeom*> grounds{};      // geoms that stand in for a visible floor*, and so are floors as well
};
SolidRoom MakeSolid(mjSpec* spec, const mjModel* alone, const Materials& materials, const std::filesystem::path& room);
constexpr std::size_t kPiecesMax = 2000;  // of one mesh

// The name of the visible geom that this colliding one belongs to: GeomName (sim/world/room.h) without "#1".
std::string SeenName(const mjModel* model, int geom);

}  // namespace merlin::sim
