// Which parts of a room the car touches: everything that its cameras see, in the shape in which they see it. In such a
// contact only the car's own friction and stiffness count.
#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "sim/world/materials.h"

namespace merlin::sim {

// Contact bits. A geom that the car is to touch has kMeetsCar in its contype; the car's shapes have it as conaffinity
// and kCarItself as contype, so that they never touch each other. The room's own bits stay: what of the room touches
// what else of it is the room's business.
constexpr int kMeetsCar = 1 << 30, kCarItself = 1 << 29;

// Of the car's shapes; geoms of the room are below it. In a contact the geom of the higher priority alone sets
// friction, condim, solref and solimp: the room's never count.
constexpr int kCarPriority = 1 << 20;

// How near matter must be to every point of a geom's surface to stand for the geom.
constexpr double kStandsFor_m = 0.05;        // another colliding geom
constexpr double kStandsForInBody_m = 0.10;  // one of the same body (not the world's): they are made for each other
constexpr double kFloorStandsFor_m = 0.02;   // a floor* or an endless plane: for what lies on it, not for a kerb

// Decides for every geom and marks or replaces it. alone: the room compiled for itself (CompileAlone in sim/world/room.h),
// its geoms in the spec's order.
//
// - A geom collides if contype or conaffinity is not 0, whatever the bits. A colliding geom that is seen
//   (sim/world/shape.h), or named floor*, meets the car. An invisible one does where its bits meet MuJoCo's default ones, or
//   where it stands for a geom that is seen.
// - A geom that is seen and does not collide meets the car, too, unless its material is passable or colliding geoms
//   stand for it: all points of its surface (a grid of 2.5 cm) are within the distances above of their matter. Only
//   geoms that move as one with it can. A passable geom that collides keeps its contacts as its bits say.
// - Margins, gaps, adhesion and moving surfaces of whatever meets the car are set to 0. A moving surface is a warning.
// - A mesh that is not convex (sim/world/mesh_pieces.h) collides as its convex pieces, a panel (sim/world/shape.h) as a slab of
//   kSlab_m: invisible geoms "NAME#1", "NAME#2", ... of the same body, which have the contact bits in its place. A
//   colliding mesh of more than kPiecesMax pieces collides as its convex hull, with a warning that names it.
// - A piece of a mesh that lies on a floor stays out: the floor stands for it. A shell may have a floor of its own.
//
// Throws InputError with all geoms, by name, that are seen, do not collide and cannot be made solid: meshes of too many
// pieces.
struct SolidRoom {
  std::vector<std::string> warnings{};  // a sentence each
  std::vector<mjsGeom*> grounds{};  // geoms, not named floor*, that stand for a floor that is only seen: floors, too
};
SolidRoom MakeSolid(mjSpec* spec, const mjModel* alone, const Materials& materials, const std::filesystem::path& room);
constexpr std::size_t kPiecesMax = 2000;  // of one mesh

// The geom that is seen where this one touches: its name, without a piece's number (GeomName in sim/world/room.h).
std::string SeenName(const mjModel* model, int geom);

}  // namespace merlin::sim
