#include "robot/description/mesh_path.h"

#include <cstdlib>

#include "tests/robot/description/car_text.h"

namespace merlin {
namespace {

using namespace car_text;
namespace fs = std::filesystem;

// An environment variable for as long as the object lives.
class Setting {
 public:
  Setting(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Setting() { unsetenv(name_); }

 private:
  const char* name_;
};

constexpr char kPackageXml[] = "<?xml version=\"1.0\"?>\n<package format=\"3\">\n  <name> racer </name>\n</package>\n";

class MeshPath : public testing::Test {
 protected:
  MeshPath() { unsetenv("ROS_PACKAGE_PATH"), unsetenv("AMENT_PREFIX_PATH"); }
  // What is found for a URDF there; its path below the folder, or the error.
  std::string Found(const std::string& urdf, const std::string& name) const {
    try {
      const fs::path file = FindMesh(files_.folder() / urdf, name, "car.urdf:7", "body");
      EXPECT_TRUE(file.is_absolute());
      return fs::relative(file, files_.folder()).string();
    } catch (const InputError& error) {
      return error.what();
    }
  }
  ForeignCar files_;
};

TEST_F(MeshPath, FindsAPackageByTheNameOfAFolderAboveTheUrdf) {
  files_.Write("ws/src/racer/meshes/body.stl", "x");
  for (const char* name : {"package://racer/meshes/body.stl", "model://racer/meshes/body.stl",
                           "$(find racer)/meshes/body.stl", "file://$(find racer)/meshes/body.stl",
                           "package://racer\\meshes\\body.stl", "package://racer//meshes/body.stl"})
    for (const char* urdf :
         {"ws/src/racer/urdf/car.urdf", "ws/src/racer/car.urdf", "ws/src/racer/urdf/robots/v2/car.urdf"})
      EXPECT_EQ(Found(urdf, name), "ws/src/racer/meshes/body.stl") << name << " from " << urdf;
}

TEST_F(MeshPath, FindsAPackageByItsPackageXml) {
  files_.Write("checkout-2/package.xml", kPackageXml);
  files_.Write("checkout-2/meshes/body.stl", "x");
  EXPECT_EQ(Found("checkout-2/urdf/car.urdf", "package://racer/meshes/body.stl"), "checkout-2/meshes/body.stl");
  // A sister package, by its folder's name or by its package.xml.
  EXPECT_EQ(Found("bringup/urdf/car.urdf", "package://racer/meshes/body.stl"), "checkout-2/meshes/body.stl");
  files_.Write("racer/meshes/wheel.stl", "x");
  EXPECT_EQ(Found("bringup/urdf/car.urdf", "package://racer/meshes/wheel.stl"), "racer/meshes/wheel.stl");
}

TEST_F(MeshPath, FindsAPackageThatTheEnvironmentLists) {
  files_.Write("a/catkin/src/repo/racer/m/body.stl", "x");
  files_.Write("b/install/share/racer/m/body.stl", "x");
  const std::string mesh = "package://racer/m/body.stl", urdf = "c/d/car.urdf", root = files_.folder().string();
  EXPECT_NE(Found(urdf, mesh).find("missing mesh"), std::string::npos);
  {
    const Setting ros("ROS_PACKAGE_PATH", "/nowhere::" + root + "/a/catkin/src");
    EXPECT_EQ(Found(urdf, mesh), "a/catkin/src/repo/racer/m/body.stl");
  }
  {
    const Setting ament("AMENT_PREFIX_PATH", root + "/c:" + root + "/b/install");
    EXPECT_EQ(Found(urdf, mesh), "b/install/share/racer/m/body.stl");
  }
}

TEST_F(MeshPath, FindsPathsFromTheUrdfsFolder) {
  files_.Write("p/meshes/body.stl", "x");
  const std::string file = (files_.folder() / "p/meshes/body.stl").string();
  for (const std::string& name : {std::string("../meshes/body.stl"), std::string("..\\meshes\\body.stl"),
                                  std::string("file://../meshes/body.stl"), file, "file://" + file})
    EXPECT_EQ(Found("p/urdf/car.urdf", name), "p/meshes/body.stl") << name;
  EXPECT_EQ(Found("p/car.urdf", "package://anything/meshes/body.stl"),
            "p/meshes/body.stl");  // a package's files without its folder
}

TEST_F(MeshPath, NamesEveryPlaceThatItLookedAt) {
  files_.Write("ws/racer/urdf/car.urdf", "x");
  const std::string root = files_.folder().string();
  const Setting ros("ROS_PACKAGE_PATH", "/opt/ros/none");
  const std::string text = Found("ws/racer/urdf/car.urdf", "package://racer/meshes/none.stl");
  ExpectSays(text, {"car.urdf:7: link 'body': missing mesh 'package://racer/meshes/none.stl'",
                    root + "/ws/racer/meshes/none.stl", root + "/ws/racer/urdf/meshes/none.stl", root + "/ws, ",
                    "ROS_PACKAGE_PATH (/opt/ros/none)", "AMENT_PREFIX_PATH (not set)"});
  EXPECT_EQ(text.find('\n'), std::string::npos);
  ExpectSays(Found("ws/racer/urdf/car.urdf", "none.stl"), {"expected a file " + root + "/ws/racer/urdf/none.stl"});
  ExpectSays(Found("car.urdf", "package://racer"), {"missing mesh"});
  ExpectSays(Found("car.urdf", ""), {"missing mesh"});
  ExpectSays(Found("car.urdf", "."), {"missing mesh"});
}

// Six times the signed volume of the triangles about the origin: positive where they face out.
double Volume6(const CarShape& shape) {
  double sum = 0.0;
  for (const Eigen::Vector3i& t : shape.mesh->triangles) {
    const auto vertex = [&](int k) {
      return Eigen::Vector3d(shape.size_m.cwiseProduct(shape.mesh->vertices[t[k]].cast<double>()));
    };
    sum += vertex(0).dot(vertex(1).cross(vertex(2)));
  }
  return sum;
}

// A tetrahedron that is its own mirror image in no axis.
TEST(MirroredMesh, IsMirroredAndFacesOut) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  for (const Eigen::Vector3d& scale : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, 1), Eigen::Vector3d(-2, 1, 1),
                                       Eigen::Vector3d(-1, -1, 0.5), Eigen::Vector3d(-1, -1, -1)}) {
    const std::string mesh = fmt::format("<geometry><mesh filename=\"t.obj\" scale=\"{} {} {}\"/></geometry>",
                                         scale.x(), scale.y(), scale.z());
    const Rover rover(Replaced(RoverUrdf(), "<collision><geometry><box size=\"0.6 0.25 0.12\"/></geometry></collision>",
                               "<visual>" + mesh + "</visual><collision>" + mesh + "</collision>"));
    rover.files().Write("t.obj", obj);
    const CarDescription car = rover.Read();
    for (const CarShape& shape : {car.links[1].visual.back(), car.links[1].collision.back()}) {
      EXPECT_NEAR(Volume6(shape), 6.0 * std::abs(scale.prod()), 1e-5);
      Eigen::AlignedBox3d box, expected(Eigen::Vector3d::Zero().eval());
      for (const Eigen::Vector3f& vertex : shape.mesh->vertices)
        box.extend(shape.size_m.cwiseProduct(vertex.cast<double>()));
      expected.extend(scale.cwiseProduct(Eigen::Vector3d(1, 2, 3)));
      EXPECT_LT((box.min() - expected.min()).norm() + (box.max() - expected.max()).norm(), 1e-6);
      EXPECT_TRUE((shape.size_m.array() > 0.0).all());
    }
  }
}

}  // namespace
}  // namespace merlin
