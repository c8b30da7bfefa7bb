#include "robot/description/mesh_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "robot/base/error.h"
#include "tests/robot/description/mesh_text.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;
using mesh_text::Box;

class MeshFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "merlin_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path File(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  std::vector<CarMesh> Read(const std::string& name, const std::string& bytes) const {
    return ReadMesh(File(name, bytes));
  }
  // The message of the InputError; empty if there is none.
  std::string ErrorOf(const std::string& name, const std::string& bytes) const {
    try {
      Read(name, bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void ExpectRefused(const std::string& name, const std::string& bytes, const std::string& says) const {
    const std::string text = ErrorOf(name, bytes);
    EXPECT_NE(text.find((folder_ / name).string() + ": "), std::string::npos) << text;
    EXPECT_NE(text.find(says), std::string::npos) << "'" << says << "' not in: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;  // one sentence
  }

  fs::path folder_;
};

// Signed volume by the divergence theorem: positive where all triangles are counter-clockwise from outside.
double Volume_m3(const CarMesh& mesh) {
  double volume = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles)
    volume += mesh.vertices[t[0]].cast<double>().dot(
                  mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>())) /
              6.0;
  return volume;
}

void ExpectBox(const std::vector<CarMesh>& parts, const Eigen::Vector3d& size_m) {
  ASSERT_EQ(parts.size(), 1u);
  const CarMesh& mesh = parts[0];
  EXPECT_EQ(mesh.triangles.size(), 12u);
  Eigen::Vector3f low = mesh.vertices.at(0), high = low;
  for (const Eigen::Vector3f& vertex : mesh.vertices) low = low.cwiseMin(vertex), high = high.cwiseMax(vertex);
  EXPECT_LT(((high - low).cast<double>() - size_m).norm(), 1e-6) << (high - low).transpose();
  EXPECT_LT((high + low).norm(), 1e-6);
  EXPECT_NEAR(Volume_m3(mesh), size_m.prod(), 1e-6 * size_m.prod());
}

TEST_F(MeshFile, ReadsTheSameBoxInEveryFormat) {
  const Box box{1, 2, 3};
  const Eigen::Vector3d size_m(1, 2, 3);
  ExpectBox(Read("box.obj", mesh_text::Obj(box)), size_m);
  ExpectBox(Read("text.stl", mesh_text::StlText(box)), size_m);
  ExpectBox(Read("binary.stl", mesh_text::StlBinary(box)), size_m);
  ExpectBox(Read("CAPITAL.STL", mesh_text::StlBinary(box)), size_m);
  ExpectBox(Read("box.dae", mesh_text::Dae({.box = box})), size_m);
  // glTF's y is up: height first there.
  ExpectBox(Read("box.glb", mesh_text::Glb({.box = {1, 3, 2}})), size_m);
  File("box.bin", mesh_text::GltfBuffer({1, 3, 2}));
  ExpectBox(Read("box.gltf", mesh_text::GltfJson({.box = {1, 3, 2}}, R"("uri":"box.bin",)")), size_m);
}

// A corner of its own on each axis tells turned from mirrored.
TEST_F(MeshFile, ObeysColladasUnitAndUpAxis) {
  for (const double unit_m : {1.0, 0.01, 0.0254}) {
    const auto box = [&](const std::string& up) {
      return mesh_text::Dae({.box = {1, 2, 3}, .up = up, .unit_m = unit_m});
    };
    ExpectBox(Read("z.dae", box("Z_UP")), unit_m * Eigen::Vector3d(1, 2, 3));
    ExpectBox(Read("y.dae", box("Y_UP")), unit_m * Eigen::Vector3d(1, 3, 2));
    ExpectBox(Read("x.dae", box("X_UP")), unit_m * Eigen::Vector3d(2, 3, 1));
  }
}

TEST_F(MeshFile, TakesColoursWhereTheFileHasThem) {
  const std::array<float, 4> blue{0.2f, 0.4f, 0.6f, 1.0f};
  EXPECT_EQ(Read("box.dae", mesh_text::Dae({})).at(0).rgba, blue);
  EXPECT_EQ(Read("box.glb", mesh_text::Glb({})).at(0).rgba, blue);
  File("box.mtl", "newmtl paint\nKd 0.2 0.4 0.6\n");
  std::string obj = mesh_text::Obj({});
  EXPECT_EQ(Read("box.obj", "mtllib box.mtl\nusemtl paint\n" + obj).at(0).rgba, blue);
  EXPECT_FALSE(Read("plain.obj", obj).at(0).rgba);
  EXPECT_FALSE(Read("text.stl", mesh_text::StlText({})).at(0).rgba);
  EXPECT_FALSE(Read("binary.stl", mesh_text::StlBinary({})).at(0).rgba);
  // Two colours are two parts.
  File("two.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
  const std::size_t middle = obj.find("f 1 2 6");
  const auto parts = Read("two.obj", "mtllib two.mtl\nusemtl a\n" + obj.insert(middle, "usemtl b\n"));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].triangles.size(), 4u);
  EXPECT_EQ(parts[1].rgba, (std::array<float, 4>{0, 1, 0, 1}));
}

TEST_F(MeshFile, RejectsAFileThatIsNotAMesh) {
  EXPECT_THROW(ReadMesh("/nowhere/x.obj"), InputError);
  ExpectRefused("x.png", "x", "not a mesh format that can be read");
  for (const std::string ending : {"obj", "stl", "dae", "gltf", "glb"}) {
    ExpectRefused("empty." + ending, "", "");
    ExpectRefused("words." + ending, "this is no mesh at all, but some words\n", "");
    ExpectRefused("zeros." + ending, std::string(1000, '\0'), "");
  }
}

TEST_F(MeshFile, RefusesAMeshThatIsCutOff) {
  const std::string stl = mesh_text::StlBinary({}), glb = mesh_text::Glb({}), dae = mesh_text::Dae({});
  ExpectRefused("cut.stl", stl.substr(0, stl.size() - 1), "not a mesh");
  ExpectRefused("cut.glb", glb.substr(0, glb.size() - 60), "not a mesh");
  ExpectRefused("cut.dae", dae.substr(0, dae.size() / 2), "not a mesh");
  ExpectRefused("alone.gltf", mesh_text::GltfJson({}, R"("uri":"none.bin",)"), "not a mesh");
}

TEST_F(MeshFile, RefusesCountsThatLie) {
  for (const std::uint32_t claimed : {13u, 1000000u, 0xffffffffu})
    ExpectRefused("lie.stl", mesh_text::StlBinary({}, claimed), "");
  for (const std::string claimed : {"4000000000", "-1", "99999999999999999999"})
    ExpectRefused("lie.glb", mesh_text::Glb({.claimed = claimed}), "");
  for (const std::string claimed : {"25", "4000000000", "-1"})
    ExpectRefused("lie.dae", mesh_text::Dae({.claimed = claimed}), "");
  ExpectRefused("lie.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n", "");
}

// assimp 5.2 refuses a vertex more than the file has room for; 5.4 reads one from the bytes behind, which no triangle
// names.
TEST_F(MeshFile, TakesNoVertexThatOnlyItsCountTellsOf) {
  const std::string lie = mesh_text::Glb({.box = {1, 3, 2}, .claimed = "9"});
  if (ErrorOf("lie.glb", lie).empty())
    ExpectBox(Read("lie.glb", lie), {1, 2, 3});
  else
    ExpectRefused("lie.glb", lie, "");
}

TEST_F(MeshFile, LeavesOutVerticesThatNoTriangleNames) {
  ExpectBox(Read("loose.obj", mesh_text::Obj({1, 2, 3}) + "v 9 9 9\nv -9 9 9\nf 9 10 9\n"), {1, 2, 3});  // without area
}

TEST_F(MeshFile, RefusesNoTriangles) {
  ExpectRefused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "");
  ExpectRefused("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", "no triangles");
  ExpectRefused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangles");  // without area
  ExpectRefused("none.stl", mesh_text::StlBinary({}, 0).substr(0, 84), "");
}

TEST_F(MeshFile, RefusesVerticesThatAreNotFinite) {
  for (const std::string bad : {"nan", "inf", "1e300"}) {
    std::string obj = mesh_text::Obj({});
    obj.replace(obj.find("-0.5"), 4, bad);
    ExpectRefused("bad.obj", obj, "");
  }
  std::string stl = mesh_text::StlBinary({});
  const float nan = std::nanf("");
  std::memcpy(stl.data() + 84 + 12, &nan, sizeof nan);
  ExpectRefused("bad.stl", stl, "");
}

TEST_F(MeshFile, RefusesTooManyTriangles) {
  std::string stl = mesh_text::StlBinary({}, kMeshTrianglesMax + 1);
  const std::string triangle = stl.substr(84, 50);
  stl.resize(84);
  for (int i = 0; i <= kMeshTrianglesMax; ++i) stl += triangle;
  ExpectRefused("many.stl", stl, "too many triangles");
}

// Bytes changed, cut and repeated at random: the result is always a mesh or one sentence.
TEST_F(MeshFile, SurvivesMutatedFiles) {
  const std::map<std::string, std::string> seeds{
      {"m.obj", mesh_text::Obj({})},       {"t.stl", mesh_text::StlText({})},
      {"b.stl", mesh_text::StlBinary({})}, {"m.dae", mesh_text::Dae({})},
      {"m.glb", mesh_text::Glb({})},       {"m.gltf", mesh_text::GltfJson({}, R"("uri":"m.bin",)")}};
  File("m.bin", mesh_text::GltfBuffer({}));
  std::mt19937 random(1);
  const int rounds = 25;
  int read = 0, refused = 0;
  for (int round = 0; round < rounds; ++round)
    for (const auto& [name, seed] : seeds) {
      std::string bytes = seed;
      const auto place = [&] { return random() % bytes.size(); };
      for (unsigned k = 1 + random() % 4; k > 0 && !bytes.empty(); --k) switch (random() % 5) {
          case 0:
            bytes[place()] = static_cast<char>(random());
            break;
          case 1:
            bytes[place()] ^= static_cast<char>(1u << random() % 8);
            break;
          case 2:
            bytes.resize(place());
            break;
          case 3:
            bytes.insert(place(), bytes.substr(place(), random() % 40));
            break;
          default:
            bytes.erase(place(), random() % 20);
        }
      try {
        for (const CarMesh& part : Read(name, bytes)) {
          for (const Eigen::Vector3f& vertex : part.vertices) EXPECT_TRUE(vertex.allFinite());
          for (const Eigen::Vector3i& t : part.triangles)
            EXPECT_LT(t.maxCoeff(), static_cast<int>(part.vertices.size()));
        }
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace merlin
