#include "robot/description/mesh_file.h"

#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <cstring>
#include <map>
#include <string_view>

#include "robot/base/error.h"
#include "robot/description/apart.h"

namespace merlin {
namespace {

constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                            aiProcess_GlobalScale | aiProcess_ValidateDataStructure;

std::string Ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

void RefuseByLooks(const std::filesystem::path& file) {
  const std::string ending = Ending(file);
  if (ending != ".obj" && ending != ".stl" && ending != ".dae" && ending != ".gltf" && ending != ".glb")
    throw InputError(file.string(), "not a mesh format that can be read", "a file .obj, .stl, .dae, .gltf or .glb");
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) throw InputError(file.string(), "cannot be read", "a mesh");
  if (bytes > kMeshBytesMax)
    throw InputError(file.string(), "mesh too large", fmt::format("at most {} bytes", kMeshBytesMax),
                     fmt::format("{}", bytes));
}

const aiScene& Import(const std::filesystem::path& file, Assimp::Importer& importer) {
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(file.string(), kSteps);
    reason = importer.GetErrorString();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(file.string(), "not a mesh" + (reason.empty() ? "" : " (" + reason + ")"));
  return *scene;
}

Eigen::Affine3d ToAffine(const aiMatrix4x4& m) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return result;
}

// Removes vertices that no triangle uses; they would enlarge the convex hull. Some are stray points, others are garbage
// that assimp reads if the file gives a wrong count.
CarMesh WithoutLooseVertices(const CarMesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const Eigen::Vector3i& corners : mesh.triangles)
    for (const int corner : corners) number[static_cast<std::size_t>(corner)] = 0;
  CarMesh kept{.vertices = {}, .triangles = mesh.triangles, .rgba = mesh.rgba};
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(kept.vertices.size());
    kept.vertices.push_back(mesh.vertices[i]);
  }
  for (Eigen::Vector3i& corners : kept.triangles)
    for (int& corner : corners) corner = number[static_cast<std::size_t>(corner)];
  return kept;
}

class Collector {
 public:
  Collector(const std::filesystem::path& file, const aiScene& scene) : file_(file.string()), scene_(scene) {}

  void Walk(const aiNode& node, const Eigen::Affine3d& T_file_parent) {
    const Eigen::Affine3d T_file_node = T_file_parent * ToAffine(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) Add(*scene_.mMeshes[node.mMeshes[i]], T_file_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) Walk(*node.mChildren[i], T_file_node);
  }
  std::vector<CarMesh> Parts() const {
    std::vector<CarMesh> parts;
    for (const auto& [material, mesh] : parts_)
      if (!mesh.triangles.empty()) parts.push_back(WithoutLooseVertices(mesh));
    return parts;
  }

 private:
  void Add(const aiMesh& from, const Eigen::Affine3d& T_file_node) {
    if (from.mNumFaces == 0) return;
    count_ += from.mNumFaces;
    if (count_ > kMeshTrianglesMax || from.mNumVertices > 3 * kMeshTrianglesMax)
      throw InputError(file_, "too many triangles", fmt::format("at most {}", kMeshTrianglesMax));
    CarMesh& to = Part(from.mMaterialIndex);
    const int first = static_cast<int>(to.vertices.size());
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      const aiVector3D& v = from.mVertices[i];
      const Eigen::Vector3d vertex = T_file_node * Eigen::Vector3d(v.x, v.y, v.z);
      if (!vertex.allFinite()) throw InputError(file_, "a vertex is not finite");
      to.vertices.push_back(vertex.cast<float>());
    }
    const bool mirrored = T_file_node.linear().determinant() < 0.0;  // then corners swap: surfaces keep facing outwards
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      if (face.mNumIndices != 3) continue;
      Eigen::Vector3i corners;
      for (int k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= from.mNumVertices)
          throw InputError(file_, "a triangle names a vertex that is not there");
        corners[mirrored ? 2 - k : k] = first + static_cast<int>(face.mIndices[k]);
      }
      const Eigen::Vector3f &a = to.vertices[corners[0]], &b = to.vertices[corners[1]], &c = to.vertices[corners[2]];
      if ((b - a).cross(c - a).norm() > 0.0f) to.triangles.push_back(corners);
    }
  }
  CarMesh& Part(unsigned material) {
    const auto [part, is_new] = parts_.try_emplace(material);
    if (is_new && material < scene_.mNumMaterials) {
      const aiMaterial& from = *scene_.mMaterials[material];
      aiColor4D color;
      float opacity = 1.0f;
      const bool stated = std::string(from.GetName().C_Str()) != AI_DEFAULT_MATERIAL_NAME && from.GetName().length > 0;
      if (stated && from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
        if (from.Get(AI_MATKEY_OPACITY, opacity) != aiReturn_SUCCESS) opacity = 1.0f;
        part->second.rgba = {color.r, color.g, color.b, opacity};
      }
    }
    return part->second;
  }

  std::string file_;
  const aiScene& scene_;
  std::map<unsigned, CarMesh> parts_;
  std::size_t count_ = 0;
};

std::vector<CarMesh> ReadHere(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene& scene = Import(file, importer);
  // assimp turns every COLLADA file to y up by the transform of its root, whatever the file's own axis; glTF is y up.
  Eigen::Affine3d T_z_up_file = Eigen::Affine3d::Identity();
  const std::string ending = Ending(file);
  if (ending != ".obj" && ending != ".stl") T_z_up_file.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  Collector collector(file, scene);
  collector.Walk(*scene.mRootNode, T_z_up_file);
  std::vector<CarMesh> parts = collector.Parts();
  if (parts.empty()) throw InputError(file.string(), "the mesh has no triangles");
  return parts;
}

// The format between the two processes: counts and arrays as they lie in memory.
constexpr char kMeshMark = '\1';

template <class T>
void Append(const T* data, std::size_t count, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(data), count * sizeof(T));
}
template <class T>
void Take(std::string_view& bytes, T* data, std::size_t count) {
  std::memcpy(static_cast<void*>(data), bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
}

struct PartHead {
  std::uint64_t vertices = 0, triangles = 0;
  bool has_color = false;
  std::array<float, 4> rgba{};
};

std::string ToBytes(const std::vector<CarMesh>& parts) {
  std::string bytes;
  for (const CarMesh& part : parts) {
    const PartHead head{part.vertices.size(), part.triangles.size(), part.rgba.has_value(),
                        part.rgba.value_or(PartHead{}.rgba)};
    Append(&head, 1, bytes);
    Append(part.vertices.data(), part.vertices.size(), bytes);
    Append(part.triangles.data(), part.triangles.size(), bytes);
  }
  return bytes;
}

std::vector<CarMesh> FromBytes(std::string_view bytes) {
  std::vector<CarMesh> parts;
  while (!bytes.empty()) {
    PartHead head;
    Take(bytes, &head, 1);
    CarMesh& part = parts.emplace_back();
    part.vertices.resize(head.vertices), part.triangles.resize(head.triangles);
    Take(bytes, part.vertices.data(), part.vertices.size());
    Take(bytes, part.triangles.data(), part.triangles.size());
    if (head.has_color) part.rgba = head.rgba;
  }
  return parts;
}

}  // namespace

std::vector<CarMesh> ReadMesh(const std::filesystem::path& file) {
  RefuseByLooks(file);
  const ApartResult result = RunApart([&file]() -> std::string {
    try {
      return kMeshMark + ToBytes(ReadHere(file));
    } catch (const InputError& error) {
      return error.what();
    } catch (const std::exception& error) {  // out of memory
      return InputError(file.string(), fmt::format("not a mesh ({})", error.what())).what();
    }
  });
  if (!result.finished) throw InputError(file.string(), "not a mesh (assimp fails on it)");
  if (!result.bytes.starts_with(kMeshMark)) throw InputError(result.bytes);
  return FromBytes(std::string_view(result.bytes).substr(1));
}

CarMesh Joined(const std::vector<std::shared_ptr<const CarMesh>>& parts) {
  CarMesh mesh;
  for (const auto& part : parts) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part->vertices.begin(), part->vertices.end());
    for (const Eigen::Vector3i& triangle : part->triangles)
      mesh.triangles.push_back(triangle + Eigen::Vector3i::Constant(first));
  }
  return mesh;
}

}  // namespace merlin
