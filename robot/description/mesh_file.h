// Reads the triangles of a mesh file: OBJ, STL (text and binary), COLLADA (.dae), glTF (.gltf, .glb), by assimp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "robot/types/car.h"

namespace merlin {

constexpr int kMeshTrianglesMax = 200'000;          // of one file
constexpr std::uintmax_t kMeshBytesMax = 64 << 20;  // of one file

// One part for each material of the file, in metres with z up: COLLADA's <unit> and <up_axis> are obeyed, glTF, which
// is always y up, is turned like COLLADA's Y_UP (by 90 deg about x, as modelling programs write it). OBJ and STL say
// neither: their numbers are taken as they are, URDF's scale comes on top. A colour is the material's diffuse one;
// pictures on surfaces, lines, points, skeletons and animations are left out. assimp runs in a process of its own: some
// files with wrong counts bring it down. Throws InputError with the file: not readable, too large, not such a mesh, no
// triangles, a vertex that is not finite.
std::vector<CarMesh> ReadMesh(const std::filesystem::path& file);

// The parts as one, without colour.
CarMesh Joined(const std::vector<std::shared_ptr<const CarMesh>>& parts);

}  // namespace merlin
