// The meshes of a car: how ReadCar finds them, and that they match the collision shapes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "tests/robot/description/description_fixture.h"
#include "tests/robot/description/mesh_text.h"

namespace merlin {
namespace {

using namespace car_text;

TEST_F(Description, ResolvesMeshesAgainstTheUrdfsFolder) {
  const std::string box = "<mesh filename=\"meshes/chassis.dae\"/>";
  File("body.stl", mesh_text::StlText({}));
  for (const std::string name : {"body.stl", "package://merlin/body.stl", "./body.stl"}) {
    const fs::path urdf = File("car.urdf", Replaced(merlin_, box, "<mesh filename=\"" + name + "\" scale=\"1 2 3\"/>"));
    const CarDescription car = ReadCar(urdf);
    const CarShape& shape = Link(car, "chassis").visual[0];
    EXPECT_EQ(shape.kind, CarShape::Kind::kMesh);
    EXPECT_TRUE(shape.mesh_file.is_absolute());
    EXPECT_TRUE(fs::equivalent(shape.mesh_file, folder_ / "body.stl"));
    EXPECT_EQ(shape.size_m, Eigen::Vector3d(1, 2, 3));
  }
  for (const std::string name : {"none.stl", "package://merlin/none.stl", "package://merlin", "/nowhere/none.stl"}) {
    const std::string text = Replaced(merlin_, box, "<mesh filename=\"" + name + "\"/>");
    ExpectSays(CarError(text), {"car.urdf:" + std::to_string(LineOf(text, "<link name=\"chassis\">")), "missing mesh"});
  }
}

TEST_F(Description, NamesAMeshThatIsNone) {
  File("body.dae", "no mesh");
  ExpectSays(CarError(Replaced(merlin_, "meshes/chassis.dae", "body.dae")), {"body.dae: not a mesh"});
  File("flat.stl", mesh_text::StlText({.z = 0.0}));
  ExpectSays(CarError(Replaced(merlin_, "<collision><geometry><box size=\"0.12 0.15 0.04\"/></geometry></collision>",
                               "<collision><geometry><mesh filename=\"flat.stl\"/></geometry></collision>")),
             {"car.urdf:", "link 'pc'", "flat.stl is flat"});
}

// The files are small, have few triangles, and are exactly what their script makes.
TEST_F(Description, MeshesAreLightAndMadeByTheirScript) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  std::size_t triangles = 0;
  std::set<std::string> endings;
  for (const CarLink& link : car.links)
    for (const CarShape& shape : link.visual)
      if (shape.mesh) triangles += shape.mesh->triangles.size(), endings.insert(shape.mesh_file.extension().string());
  EXPECT_LT(triangles, 15100u);
  EXPECT_EQ(endings, (std::set<std::string>{".dae", ".glb", ".obj", ".stl"}));
  const fs::path made = folder_ / "made";
  fs::create_directory(made);
  fs::copy_file(Model("merlin/meshes/make.py"), made / "make.py");
  ASSERT_EQ(std::system(("python3 " + (made / "make.py").string()).c_str()), 0);
  std::uintmax_t bytes = 0;
  for (const auto& file : fs::directory_iterator(Model("merlin/meshes"))) {
    EXPECT_EQ(Text(file.path()), Text(made / file.path().filename())) << file.path();
    bytes += file.file_size();
  }
  EXPECT_LT(bytes, 1'000'000u);
}

// What is seen is as large as what collides.
TEST_F(Description, MeshesFitTheShapesThatTouch) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  const auto extent = [](const CarLink& link) {
    Eigen::AlignedBox3d box;
    for (const CarShape& shape : link.visual)
      if (shape.mesh)
        for (const Eigen::Vector3f& vertex : shape.mesh->vertices)
          box.extend(shape.T_link_shape * vertex.cast<double>());
    return box;
  };
  for (const CarWheel& wheel : car.wheels) {
    const Eigen::AlignedBox3d box = extent(car.links[wheel.link]);
    EXPECT_NEAR(box.max().z(), car.wheel_radius_m, 1e-4);
    EXPECT_NEAR(box.sizes().x(), 2.0 * car.wheel_radius_m, 1e-3);  // a polygon's corner or edge
    EXPECT_NEAR(box.sizes().y(), wheel.width_m, 1e-4);
  }
  const Eigen::AlignedBox3d chassis = extent(Link(car, "chassis"));
  EXPECT_NEAR(chassis.min().x(), -0.09, 1e-3);
  EXPECT_NEAR(chassis.max().x(), 0.45, 1e-3);
  EXPECT_NEAR(chassis.max().y(), 0.15, 1e-3);
  EXPECT_NEAR(chassis.min().y(), -0.15, 1e-3);
  for (const char* camera : {"depth_camera", "color_camera"}) {
    const CarLink& link = Link(car, camera);
    EXPECT_LT((extent(link).sizes() - link.collision[0].size_m).cwiseAbs().maxCoeff(), 1.1e-3) << camera;
  }
}

}  // namespace
}  // namespace merlin
