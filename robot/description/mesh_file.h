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

// Returns one part for each material of the file, in metres with z up. COLLADA's <unit> and <up_axis> are obeyed. glTF,
// which is always y up, is turned like COLLADA's Y_UP (by 90 deg about x, as modelling programs write it). OBJ and STL
// give neither unit nor axis: their numbers are used unchanged, and the scale in the URDF is applied later. The colour
// is the material's diffuse colour. Textures, lines, points, skeletons and animations are ignored. assimp runs in a
// process of its own, because some files with wrong counts crash it. Throws InputError, which names the file: not
// readable, too large, not a mesh of these formats, no triangles, a vertex that is not finite.
std::vector<CarMesh> ReadMesh(const std::filesystem::path& file);

// The parts as one, without colour.
CarMesh Joined(const std::vector<std::shared_ptr<const CarMesh>>& parts);

}  // namespace merlin
