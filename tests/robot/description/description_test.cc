#include "robot/description/description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <regex>
#include <set>

#include "robot/base/error.h"
#include "tests/robot/description/car_text.h"
#include "tests/robot/description/mesh_text.h"

namespace merlin {
namespace {

using namespace car_text;

namespace fs = std::filesystem;

fs::path Model(const std::string& name) { return fs::path(MERLIN_SOURCE_DIR) / "models" / name; }

std::string Text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// What the InputError of a call says; empty if there is none.
template <class Call>
std::string ErrorOf(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

class Description : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "merlin_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    fs::create_directory_symlink(Model("merlin/meshes"), folder_ / "meshes");
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path File(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string CarError(const std::string& urdf) const {
    return ErrorOf([&] { ReadCar(File("car.urdf", urdf)); });
  }
  std::string DepthError(const std::string& yaml) const {
    return ErrorOf([&] { ReadDepthCameraSheet(File("camera.yaml", yaml)); });
  }
  // The sheet of the PMD 3k-S with these lines as its errors.
  std::string WithErrors(const std::string& lines) const {
    return pmd_.substr(0, pmd_.find("errors:")) + "errors:\n" + lines;
  }
  std::string ColorError(const std::string& yaml) const {
    return ErrorOf([&] { ReadColorCameraSheet(File("camera.yaml", yaml)); });
  }

  fs::path folder_;
  std::string merlin_ = Text(Model("merlin/merlin.urdf"));
  std::string pmd_ = Text(Model("cameras/pmd_3k_s.yaml"));
  std::string ccd_ = Text(Model("cameras/ccd.yaml"));
};

const CarLink& Link(const CarDescription& car, const char* name) {
  return *std::find_if(car.links.begin(), car.links.end(), [&](const CarLink& link) { return link.name == name; });
}

TEST_F(Description, MerlinHasItsGeometry) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  EXPECT_EQ(car.name, "merlin");
  EXPECT_NEAR(car.wheelbase_m, 0.33, 1e-12);
  EXPECT_NEAR(car.track_m, 0.26, 1e-12);
  EXPECT_NEAR(car.wheel_radius_m, 0.055, 1e-12);
  EXPECT_NEAR(car.steering_max_rad, 25.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_EQ(car.drivetrain.gear, 10.0);
  EXPECT_EQ(car.drivetrain.encoder_counts_per_motor_turn, 512);
  EXPECT_EQ(car.drivetrain.motor_constant_v_s, 0.03);
  EXPECT_EQ(car.drivetrain.resistance_ohm, 0.6);
  EXPECT_EQ(car.drivetrain.rotor_inertia_kg_m2, 2e-5);
  EXPECT_EQ(car.drivetrain.voltage_max_v, 12.0);
  EXPECT_EQ(car.drivetrain.speed_max_m_s, 2.0);
  EXPECT_EQ(car.drivetrain.acceleration_max_m_s2, 2.0);
  EXPECT_EQ(car.drivetrain.steering_slew_rad_s, 3.2);
  EXPECT_EQ(car.drivetrain.tyre_friction, 0.9);
  EXPECT_NEAR(car.MetresPerCount(), 2.0 * std::numbers::pi * 0.055 / 5120.0, 1e-15);
}

TEST_F(Description, MerlinWeighsSixAndAHalfKilogramsLow) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  std::map<std::string, Pose> T_base;
  double mass_kg = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const CarLink& link : car.links) {
    T_base[link.name] = link.parent.empty() ? Pose::Identity() : T_base.at(link.parent) * link.T_parent_link;
    mass_kg += link.mass_kg;
    moment += link.mass_kg * (T_base[link.name] * link.T_link_inertial).translation();
  }
  EXPECT_NEAR(mass_kg, 6.5, 1e-12);
  EXPECT_NEAR(moment.z() / mass_kg, 0.110, 0.0005);
  EXPECT_NEAR(moment.x() / mass_kg, 0.151, 0.0005);
  EXPECT_NEAR(moment.y() / mass_kg, 0.0, 0.001);
}

TEST_F(Description, ParentsComeBeforeChildren) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  EXPECT_EQ(car.links[0].name, "base_link");
  EXPECT_EQ(car.links[0].parent, "");
  std::set<std::string> seen;
  for (const CarLink& link : car.links) {
    EXPECT_TRUE(link.parent.empty() || seen.contains(link.parent)) << link.name;
    seen.insert(link.name);
  }
  EXPECT_EQ(Link(car, "wheel_front_left").parent, "knuckle_front_left");
  EXPECT_EQ(Link(car, "wheel_front_left").joint, CarLink::Joint::kContinuous);
  EXPECT_EQ(Link(car, "knuckle_front_left").joint, CarLink::Joint::kRevolute);
  EXPECT_EQ(Link(car, "pc").joint, CarLink::Joint::kFixed);
}

TEST_F(Description, ShapesHaveSizeColourAndMaterial) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  const CarLink& wheel = Link(car, "wheel_rear_right");
  ASSERT_EQ(wheel.collision.size(), 1u);
  EXPECT_EQ(wheel.collision[0].kind, CarShape::Kind::kCylinder);
  EXPECT_EQ(wheel.collision[0].size_m, Eigen::Vector3d(0.055, 0.04, 0.0));
  EXPECT_LT((wheel.collision[0].T_link_shape.linear().col(2).cwiseAbs() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  const CarShape& battery = Link(car, "batteries").visual[0];
  EXPECT_EQ(battery.kind, CarShape::Kind::kBox);
  EXPECT_EQ(battery.material, "car_battery");
  EXPECT_EQ(battery.rgba, (std::array<float, 4>{0.10f, 0.16f, 0.45f, 1.0f}));
  EXPECT_EQ(wheel.visual[0].rgba, (std::array<float, 4>{0.05f, 0.05f, 0.05f, 1.0f}));  // the mesh's own
  EXPECT_EQ(Link(car, "camera_mast").visual[0].material, "car_aluminium");             // painted by the URDF
}

TEST_F(Description, DepthCameraLooksAheadLevel) {
  const Pose T_base_depth = ReadCar(Model("merlin/merlin.urdf")).T_base_depth;
  EXPECT_LT((T_base_depth.translation() - Eigen::Vector3d(0.30, 0.0, 0.35)).norm(), 1e-12);
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);  // ahead
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-12);  // right
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);  // down
}

// Table 4.5 of the thesis, read as q_CCD = R q_PMD + t.
// The thesis: "Autonomous navigation and mapping of mobile robots based on 2D/3D cameras combination",
// University of Siegen, about 2011.
TEST_F(Description, ColourCameraStandsWhereTable45Says) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  const Pose T_ccd_pmd = car.T_base_color->inverse() * car.T_base_depth;
  const Eigen::Vector3d rotation_vector(0.05058, 0.07940, -0.01120), translation_mm(14.31872, 63.96501, 70.83500);
  EXPECT_LT((T_ccd_pmd.translation() * 1e3 - translation_mm).norm(), 1e-6);
  EXPECT_LT((LogSo3(T_ccd_pmd.linear()) - rotation_vector).norm(), 1e-9);
  // Above the depth camera and behind it, both looking ahead.
  const Eigen::Vector3d offset_base = car.T_base_color->translation() - car.T_base_depth.translation();
  EXPECT_NEAR(offset_base.z(), 0.064, 0.004);
  EXPECT_NEAR(offset_base.x(), -0.071, 0.004);
  EXPECT_GT(car.T_base_color->linear()(0, 2), 0.99);
}

TEST_F(Description, CompassStandsOnItsMastInTheBodysAxes) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  EXPECT_EQ(car.T_base_compass->linear(), Eigen::Matrix3d::Identity());
  const CarLink& mast = Link(car, "compass_mast");
  EXPECT_NEAR(mast.collision[0].size_m.y(), 0.20, 1e-12);
  const double top_m = mast.T_parent_link.translation().z() + mast.collision[0].T_link_shape.translation().z() + 0.10;
  EXPECT_NEAR(car.T_base_compass->translation().z(), top_m, 0.02);
}

TEST_F(Description, CarOutlineIsAsStated) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  double front_m = -1.0, half_width_m = 0.0;
  for (const CarLink& link : car.links)
    for (const CarShape& shape : link.collision) {
      if (shape.kind == CarShape::Kind::kBox && link.parent == "base_link")
        front_m =
            std::max(front_m, (link.T_parent_link * shape.T_link_shape).translation().x() + 0.5 * shape.size_m.x());
      if (link.joint == CarLink::Joint::kContinuous) half_width_m = 0.5 * (car.track_m + shape.size_m.y());
    }
  EXPECT_NEAR(front_m, 0.45, 1e-12);
  EXPECT_NEAR(half_width_m, 0.15, 1e-12);
}

TEST_F(Description, RefusesAFileThatIsNoUrdf) {
  ExpectSays(ErrorOf([] { ReadCar("/nowhere/car.urdf"); }), {"/nowhere/car.urdf", "cannot be read"});
  ExpectSays(ErrorOf([this] { ReadCar(folder_); }), {"cannot be read"});
  ExpectSays(CarError(""), {"car.urdf:1", "XML"});
  ExpectSays(CarError("<sdf/>"), {"car.urdf", "<robot>"});
  ExpectSays(CarError("<robot name=\"x\"/>"), {"car.urdf"});
}

TEST_F(Description, FindsTheJointThatTurnsTheCameras) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  ASSERT_TRUE(car.pan);
  EXPECT_EQ(car.links[car.pan->link].name, "camera_pan");
  EXPECT_FALSE(car.pan->moves);
  EXPECT_DOUBLE_EQ(car.pan->slew_rad_s, 3.2);
  EXPECT_LT((car.pan->T_base_pan.translation() - Eigen::Vector3d(0.245, 0.0, 0.315)).norm(), 1e-12);
  // A quarter to the left: what was 0.055 m ahead of the axis is beside it, and looks to the left.
  const Pose left = car.pan->Turned(car.T_base_depth, std::numbers::pi / 2.0);
  EXPECT_LT((left.translation() - Eigen::Vector3d(0.245, 0.055, 0.35)).norm(), 1e-12);
  EXPECT_LT((left.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((car.pan->Turned(*car.T_base_color, 0.0).matrix() - car.T_base_color->matrix()).norm(), 1e-12);
}

TEST_F(Description, RefusesAJointThatCannotTurnTheCameras) {
  const std::string pan = "<origin xyz=\"0.245 0 0.315\"/><axis xyz=\"0 0 1\"/>";
  const auto with = [&](const std::string& to) { return CarError(Replaced(merlin_, pan, to)); };
  ExpectSays(with("<origin xyz=\"0.245 0 0.315\"/><axis xyz=\"0 1 0\"/>"), {"pan_joint", "upright"});
  ExpectSays(CarError(Replaced(merlin_, "<joint name=\"pan_joint\" type=\"revolute\">",
                               "<joint name=\"pan_joint\" type=\"fixed\">")),
             {"pan_joint", "revolute"});
  ExpectSays(CarError(Replaced(merlin_, "lower=\"-1.5707963267948966\"", "lower=\"0.5\"")),
             {"pan_joint", "lower <= 0"});
  // Upside down: the same joint, counted the other way.
  const std::string below = Replaced(merlin_, pan, "<origin xyz=\"0.245 0 0.315\"/><axis xyz=\"0 0 -1\"/>");
  const CarDescription car =
      ReadCar(File("car.urdf", Replaced(below, "lower=\"-1.5707963267948966\"", "lower=\"-1\"")));
  EXPECT_EQ(car.links[car.pan->link].axis, Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(car.links[car.pan->link].joint_max_rad, 1.0);
  EXPECT_GT(car.pan->Turned(car.T_base_depth, 0.5).translation().y(), 0.0);
}

TEST_F(Description, NamesTheLineOfBrokenXml) {
  ExpectSays(CarError("<robot name=\"x\">\n  <link name=\"base_link\">\n</robot>"), {"car.urdf:", "XML"});
  ExpectSays(CarError("<robot name=\"x\">\n  <link name=\"base_link\"/>\n  <link name=\"a\"></lnk>\n</robot>"),
             {"car.urdf:3", "XML"});
}

TEST_F(Description, RefusesACarWithoutWhatItNeeds) {
  ExpectSays(CarError("<robot name=\"x\"><link name=\"base_link\"/></robot>"),
             {"car.urdf", "needs a joint", "wheel_front_left_joint"});
  for (const std::string frame : {"depth_camera_optical_frame", "color_camera_optical_frame", "compass_frame"}) {
    std::string renamed = merlin_;
    for (std::size_t at; (at = renamed.find("\"" + frame + "\"")) != std::string::npos;) renamed[at + 1] = 'X';
    ExpectSays(CarError(renamed), {"needs a link", frame});
  }
  ExpectSays(CarError(Replaced(merlin_, "<drivetrain", "<powertrain")), {"<drivetrain"});
  ExpectSays(CarError(Replaced(merlin_, "gear=\"10\"", "")), {"<drivetrain>", "'gear'"});
}

TEST_F(Description, NamesTheLineOfAWrongNumber) {
  const auto expect = [this](const std::string& from, const std::string& to, const std::string& element,
                             const std::string& what) {
    const std::string text = Replaced(merlin_, from, to);
    ExpectSays(CarError(text), {"car.urdf:" + std::to_string(LineOf(text, element)) + ":", what});
  };
  const std::string chassis = "<link name=\"chassis\">", mass_line = "<mass value=\"",
                    wheel = "<link name=\"wheel_front_left\">";
  for (const std::string mass : {"0", "-1"})
    expect("<mass value=\"1.68\"/>", "<mass value=\"" + mass + "\"/>", chassis, "mass");
  for (const std::string mass : {"nan", "inf", "heavy", "1 2", ""})
    expect("<mass value=\"1.68\"/>", mass_line + mass + "\"/>", mass_line, "<mass> 'value'; expected a finite number");
  expect("ixx=\"0.005404\"", "ixx=\"0\"", chassis, "inertia");
  expect("ixx=\"0.005404\"", "ixx=\"9\"", chassis, "inertia");
  expect("size=\"0.35 0.19 0.05\"", "size=\"0.35 0 0.05\"", chassis, "size");
  expect("radius=\"0.055\"", "radius=\"-0.055\"", wheel, "size");
  expect("gear=\"10\"", "gear=\"0\"", "<drivetrain", "'gear'");
  expect("gear=\"10\"", "gear=\"ten\"", "<drivetrain", "'gear'");
  expect("turn=\"512\"", "turn=\"511.5\"", "<drivetrain", "whole number");
  expect("<joint name=\"wheel_rear_left_joint\" type=\"continuous\">",
         "<joint name=\"wheel_rear_left_joint\" type=\"floating\">", "<joint name=\"wheel_rear_left_joint\"", "type");
  expect("<joint name=\"wheel_rear_left_joint\" type=\"continuous\">",
         "<joint name=\"wheel_rear_left_joint\" type=\"fixed\">", "<joint name=\"wheel_rear_left_joint\"", "turn");
}

TEST_F(Description, RefusesWheelsThatMakeNoCar) {
  const auto expect = [this](const std::string& from, const std::string& to, const std::vector<std::string>& says) {
    ExpectSays(CarError(Replaced(merlin_, from, to)), says);
  };
  const std::string rear_left = "xyz=\"0 0.13 0.055\"", rear_right = "xyz=\"0 -0.13 0.055\"";
  expect(rear_right, "xyz=\"0 -0.14 0.055\"", {"car.urdf:", "two axles of one car"});  // one farther out
  expect(rear_left, "xyz=\"0.1 0.13 0.055\"", {"two axles of one car"});               // one farther ahead
  expect(rear_left, "xyz=\"0 0.13 0.065\"", {"two axles of one car"});                 // one farther up
  expect(rear_left, "xyz=\"0 -0.13 0.055\"", {"overlap"});
  expect(rear_left, "xyz=\"nan 0.13 0.055\"", {"car.urdf"});
  expect("<cylinder radius=\"0.055\" length=\"0.04\"/></geometry>\n    </collision>",
         "<cylinder radius=\"0.05\" length=\"0.04\"/></geometry>\n    </collision>",
         {"car.urdf:", "wheel_front_right", "radius", "0.05 m"});
}

// Left and right exchanged in the roles would turn the car over; so would front and rear.
TEST_F(Description, RefusesWheelsOnTheWrongSide) {
  std::string text = merlin_;
  text = Replaced(text, "<child link=\"wheel_rear_left\"/><origin xyz=\"0 0.13",
                  "<child link=\"wheel_rear_left\"/><origin xyz=\"0 -0.13");
  text = Replaced(text, "<child link=\"wheel_rear_right\"/><origin xyz=\"0 -0.13",
                  "<child link=\"wheel_rear_right\"/><origin xyz=\"0 0.13");
  ExpectSays(CarError(text), {"do not stand as their roles say"});
}

TEST_F(Description, ReadsTheMiddleAngleFromTheKnucklesLimits) {
  // Another limit of one knuckle: the inner angle of 20 deg, or the outer one on its other side, binds the whole car.
  const double inner_rad = std::atan(1.0 / (1.0 / std::tan(20.0 * std::numbers::pi / 180.0) - 0.13 / 0.33));
  const double outer_rad = std::atan(1.0 / (1.0 / std::tan(20.0 * std::numbers::pi / 180.0) + 0.13 / 0.33));
  const std::string left = "lower=\"-0.5190064495436374\" upper=\"0.5190064495436374\"";
  for (const std::string& limits :
       std::vector<std::string>{"lower=\"-0.5190064495436374\" upper=\"" + std::to_string(inner_rad) + "\"",
                                "lower=\"" + std::to_string(-outer_rad) + "\" upper=\"0.5190064495436374\""}) {
    const CarDescription car = ReadCar(File("car.urdf", Replaced(merlin_, left, limits)));
    EXPECT_NEAR(car.steering_max_rad, 20.0 * std::numbers::pi / 180.0, 1e-6) << limits;
  }
  ExpectSays(CarError(Replaced(merlin_, left, "lower=\"0\" upper=\"0.5\"")), {"car.urdf:", "steering limits"});
}

TEST_F(Description, RefusesWhatUrdfdomRefusesAndSaysWhy) {
  testing::internal::CaptureStderr();
  const std::string text = Replaced(merlin_, "<child link=\"pc\"/>", "<child link=\"px\"/>");
  ExpectSays(CarError(text), {"car.urdf:" + std::to_string(LineOf(text, "<joint name=\"pc_joint\"")), "px"});
  ExpectSays(CarError(Replaced(merlin_, "<link name=\"pc\">", "<link name=\"chassis\">")), {"car.urdf", "chassis"});
  ExpectSays(CarError(Replaced(merlin_, "<mass value=\"1.68\"/>", "<mass value=\"heavy\"/>")), {"car.urdf"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // libraries do not print
}

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

TEST_F(Description, RefusesLinksThatHangInACircle) {
  const std::string end = "</robot>";
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/></joint>\n";
  };
  const std::string two = "<link name=\"a\"/><link name=\"b\"/>\n";
  const std::string circle = Replaced(merlin_, end, two + joint("ab", "a", "b") + joint("ba", "b", "a") + end);
  ExpectSays(CarError(circle),
             {"car.urdf:" + std::to_string(LineOf(circle, "<joint name=\"ba\"")), "'a' hangs below itself"});
  ExpectSays(CarError(Replaced(merlin_, end, two + joint("aa", "a", "a") + end)), {"'a' hangs below itself"});
  ExpectSays(CarError(Replaced(merlin_, end, joint("again", "pc", "batteries") + end)), {"'batteries' already hangs"});
  ExpectSays(CarError(Replaced(merlin_, end, two + joint("ab", "a", "b") + end)), {"car.urdf", "root"});  // two trees
}

TEST_F(Description, RefusesThreeWheelsAndNoWheels) {
  ExpectSays(CarError(Replaced(merlin_, "wheel_rear_right_joint", "spare_wheel")),
             {"car.urdf", "needs a joint 'wheel_rear_right_joint'", "car.mapping.yaml", "did you mean"});
  ExpectSays(CarError("<robot name=\"x\"><link name=\"base_link\"/></robot>"),
             {"needs a joint 'wheel_front_left_joint'"});
}

// Whatever number of the file is none: one sentence that names the file.
TEST_F(Description, RefusesEveryNumberThatIsNone) {
  const std::string text = std::regex_replace(merlin_, std::regex("<!--[^]*?-->"), "");
  const std::regex number("[ \"]([-+0-9.e]*[0-9])(?=[ \"])");
  const std::size_t start = text.find("<drivetrain");
  int numbers = 0;
  for (std::sregex_iterator match(text.begin() + static_cast<std::ptrdiff_t>(start), text.end(), number), end;
       match != end; ++match)
    for (const std::string bad : {"nan", "x"}) {
      std::string changed = text;
      changed.replace(start + static_cast<std::size_t>(match->position(1)), static_cast<std::size_t>(match->length(1)),
                      bad);
      const std::string error = CarError(changed);
      EXPECT_NE(error.find("car.urdf"), std::string::npos)
          << bad << " for number " << numbers << ": "
          << text.substr(start + static_cast<std::size_t>(match->position(1)) - 60, 80);
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
      ++numbers;
    }
  EXPECT_GT(numbers, 600);
}

TEST_F(Description, NamesAMeshThatIsNone) {
  File("body.dae", "no mesh");
  ExpectSays(CarError(Replaced(merlin_, "meshes/chassis.dae", "body.dae")), {"body.dae: not a mesh"});
  File("flat.stl", mesh_text::StlText({.z = 0.0}));
  ExpectSays(CarError(Replaced(merlin_, "<collision><geometry><box size=\"0.12 0.15 0.04\"/></geometry></collision>",
                               "<collision><geometry><mesh filename=\"flat.stl\"/></geometry></collision>")),
             {"car.urdf:", "link 'pc'", "flat.stl is flat"});
}

// The files are small, few triangles, and what their script makes.
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

// What is seen is as large as what touches.
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

TEST_F(Description, DepthCameraSheetIsThePmd3kS) {
  const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/pmd_3k_s.yaml"));
  EXPECT_EQ(sheet.name, "pmd_3k_s");
  EXPECT_EQ(sheet.camera.width, 64);
  EXPECT_EQ(sheet.camera.height, 48);
  // The edge of the outer pixels, half a pixel beyond their centres, is at half the field of view: 20 and 15 deg.
  EXPECT_NEAR(std::atan2(63.5 - sheet.camera.cx_px, sheet.camera.fx_px), 20.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_NEAR(std::atan2(-0.5 - sheet.camera.cy_px, sheet.camera.fy_px), -15.0 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_EQ(sheet.camera.cx_px, 31.5);
  EXPECT_EQ(sheet.camera.cy_px, 23.5);
  EXPECT_EQ(sheet.rate_max_hz, 120.0);
  EXPECT_DOUBLE_EQ(sheet.latency_s, 0.020);
  EXPECT_EQ(sheet.signal_e_m2_per_us, 2000.0);
  EXPECT_EQ(sheet.contrast_at_20mhz, 0.45);
  EXPECT_DOUBLE_EQ(sheet.contrast_corner_hz, 30e6);
  EXPECT_EQ(sheet.read_noise_e, 200.0);
  EXPECT_EQ(sheet.full_well_e, 1.5e6);
  EXPECT_DOUBLE_EQ(sheet.readout_s, 1e-3);
  EXPECT_DOUBLE_EQ(sheet.integration_min_s, 100e-6);
  EXPECT_DOUBLE_EQ(sheet.integration_max_s, 5000e-6);
  EXPECT_EQ(sheet.frequencies_hz, (std::vector<double>{20e6, 30e6}));
  EXPECT_TRUE(sheet.sbi);
  EXPECT_GT(sheet.low_signal_amplitude_e, 0.0);
}

// Table 4.2 of the thesis. SBI: suppression of background illumination.
struct Model42 {
  const char* name;
  int width, height;
  double horizontal_deg, vertical_deg, rate_hz;
  bool sbi;
};
constexpr Model42 kTable42[] = {
    {"camcube_2", 204, 204, 40, 40, 25, true},  {"camcube_3", 200, 200, 40, 40, 40, true},
    {"pmd_19k_s", 160, 120, 40, 30, 15, false}, {"pmd_1k_s", 64, 16, 45, 16, 100, true},
    {"pmd_3k_s", 64, 48, 40, 30, 120, true},    {"pmd_3k_s_narrow", 64, 48, 10, 12.5, 120, true},
    {"pmd_41k_s", 204, 204, 40, 40, 25, true},  {"pmd_a2", 64, 16, 52, 18, 100, true},
    {"pmd_o3", 64, 48, 40, 30, 25, true},       {"pmd_s3", 64, 48, 40, 30, 20, true},
};

TEST_F(Description, DepthCameraSheetsAreThoseOfTable42) {
  for (const Model42& model : kTable42) {
    SCOPED_TRACE(model.name);
    const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/" + std::string(model.name) + ".yaml"));
    EXPECT_EQ(sheet.name, model.name);
    EXPECT_EQ(sheet.camera.width, model.width);
    EXPECT_EQ(sheet.camera.height, model.height);
    const double deg = 180.0 / std::numbers::pi;
    EXPECT_NEAR(2.0 * deg * std::atan2(0.5 * model.width, sheet.camera.fx_px), model.horizontal_deg, 1e-9);
    EXPECT_NEAR(2.0 * deg * std::atan2(0.5 * model.height, sheet.camera.fy_px), model.vertical_deg, 1e-9);
    EXPECT_EQ(sheet.rate_max_hz, model.rate_hz);
    EXPECT_EQ(sheet.sbi, model.sbi);
  }
}

TEST_F(Description, EverySheetInTheFolderIsListedInTheTable) {
  std::set<std::string> listed{"ccd"}, found;
  for (const Model42& model : kTable42) listed.insert(model.name);
  for (const auto& entry : fs::directory_iterator(Model("cameras"))) found.insert(entry.path().stem().string());
  EXPECT_EQ(found, listed);
}

// One millisecond at 20 MHz is what a scenario asks for when it says nothing.
TEST_F(Description, EveryDepthCameraTakesTheCommonSettingsAtItsFullRate) {
  for (const Model42& model : kTable42) {
    SCOPED_TRACE(model.name);
    const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/" + std::string(model.name) + ".yaml"));
    EXPECT_NO_THROW(CheckSettings(sheet, DepthSettings{}));
    EXPECT_LE(4.0 * (1e-3 + sheet.readout_s), 1.0 / sheet.rate_max_hz);
  }
}

TEST_F(Description, TheA2SeesFortyMetres) {
  const DepthCameraSheet sheet = ReadDepthCameraSheet(Model("cameras/pmd_a2.yaml"));
  EXPECT_NEAR(UnambiguousRange_m(sheet.frequencies_hz[0]), 40.0, 0.05);
}

// K of the data sheets by the radiometry of a Lambertian surface: E_s = rho I tau / (4 F^2 d^2) on the chip, F/1.4.
TEST_F(Description, SignalsOfTheChipsGoWithPixelAreaAndLamp) {
  const auto of = [](const std::string& name) { return ReadDepthCameraSheet(Model("cameras/" + name + ".yaml")); };
  const auto lamp_w_per_sr = [](const std::string& name) {
    return ReadDepthCameraErrors(Model("cameras/" + name + ".yaml")).lamp_w_per_sr;
  };
  const double joule = 6.62607e-34 * kSpeedOfLight_m_s / 870e-9;
  const std::map<std::string, double> area_um2{
      {"pmd_1k_s", 155.3 * 210.8}, {"pmd_a2", 155.3 * 210.8}, {"pmd_3k_s", 1e4}, {"pmd_3k_s_narrow", 1e4},
      {"pmd_19k_s", 1600},         {"pmd_41k_s", 2025},       {"pmd_s3", 1e4},   {"pmd_o3", 1e4},
      {"camcube_2", 2025},         {"camcube_3", 2025}};
  for (const auto& [name, area] : area_um2) {
    const double computed = lamp_w_per_sr(name) * 0.7 / (4.0 * 1.4 * 1.4) * area * 1e-12 * 0.3 * 0.6 / joule * 1e-6;
    EXPECT_NEAR(of(name).signal_e_m2_per_us, 1.5 * computed, 0.06 * 1.5 * computed) << name;  // as rounded in the sheet
  }
}

TEST_F(Description, ErrorsOfADepthCameraAreItsSheetsOverTheDefaults) {
  for (const Model42& model : kTable42)
    EXPECT_TRUE(Validate(ReadDepthCameraErrors(Model("cameras/" + std::string(model.name) + ".yaml"))).empty())
        << model.name;
  const DepthCameraErrors cube = ReadDepthCameraErrors(Model("cameras/camcube_3.yaml"));
  EXPECT_EQ(cube.lamp_baseline_m, 0.12);
  EXPECT_EQ(cube.lamp_w_per_sr, 3.0);
  EXPECT_EQ(cube.harmonic_3, DepthCameraErrors{}.harmonic_3);
  const fs::path file = File("camera.yaml", WithErrors("  harmonic_3: 0.07\n  warmup_m: -0.01\n"));
  EXPECT_EQ(ReadDepthCameraErrors(file).harmonic_3, 0.07);
  EXPECT_EQ(ReadDepthCameraErrors(file).warmup_m, -0.01);
  EXPECT_EQ(ReadDepthCameraErrors(file).lamp_baseline_m, 0.0);
  EXPECT_EQ(ReadDepthCameraSheet(file).name, "pmd_3k_s");
}

TEST_F(Description, ASheetWithoutErrorsHasTheDefaults) {
  for (const std::string& text : {WithErrors(""), WithErrors("  {}\n"), pmd_.substr(0, pmd_.find("errors:"))}) {
    const DepthCameraErrors errors = ReadDepthCameraErrors(File("camera.yaml", text));
    EXPECT_EQ(errors.harmonic_3, DepthCameraErrors{}.harmonic_3);
    EXPECT_EQ(errors.lamp_baseline_m, DepthCameraErrors{}.lamp_baseline_m);
  }
}

TEST_F(Description, BothReadersRefuseBadErrorsWithAllFaultsAtOnce) {
  std::string text =
      WithErrors("  harmonic_3: 0.9\n  dead_share: 0.6\n  hot_share: many\n  lamp_baselin_m: 0.1\n  warmup_m: nan\n");
  text = Replaced(text, "full_well_e: 1.5e+6", "full_well_e: -1    ");
  const std::string sheet = DepthError(text);
  EXPECT_EQ(sheet, ErrorOf([&] { ReadDepthCameraErrors(File("camera.yaml", text)); }));
  for (const std::string key : {"harmonic_3", "dead_share", "hot_share", "warmup_m"})
    ExpectSays(sheet, {"camera.yaml:" + std::to_string(LineOf(text, key + ":")) + ": errors." + key + ": expected"});
  ExpectSays(sheet, {"camera.yaml:" + std::to_string(LineOf(text, "full_well_e:")) + ": full_well_e: expected"});
  ExpectSays(sheet, {"camera.yaml:" + std::to_string(LineOf(text, "lamp_baselin_m")) +
                     ": errors.lamp_baselin_m: unknown key; did you mean 'lamp_baseline_m'?"});
  EXPECT_EQ(std::count(sheet.begin(), sheet.end(), '\n'), 5);
}

TEST_F(Description, ErrorsMustBeAMap) {
  for (const std::string errors : {"errors: none\n", "errors: [1, 2]\n"})
    ExpectSays(DepthError(pmd_.substr(0, pmd_.find("errors:")) + errors),
               {"camera.yaml:", "errors: expected a map of keys"});
}

TEST_F(Description, ColourCameraSheetIsTable43) {
  const ColorCameraSheet sheet = ReadColorCameraSheet(Model("cameras/ccd.yaml"));
  EXPECT_EQ(sheet.name, "ccd");
  EXPECT_EQ(sheet.camera.width, 640);
  EXPECT_EQ(sheet.camera.height, 480);
  EXPECT_EQ(sheet.camera.fx_px, 780.037);
  EXPECT_EQ(sheet.camera.fy_px, 777.844);
  EXPECT_EQ(sheet.camera.cx_px, 353.244);
  EXPECT_EQ(sheet.camera.cy_px, 223.784);
  EXPECT_EQ(sheet.camera.k1, 0.024);
  EXPECT_EQ(sheet.camera.k2, 0.015);
  EXPECT_EQ(sheet.camera.p1, -0.006);
  EXPECT_EQ(sheet.camera.p2, 0.0109);
  EXPECT_EQ(sheet.rate_max_hz, 30.0);
  EXPECT_DOUBLE_EQ(sheet.latency_s, 0.050);
  EXPECT_LE(sheet.exposure_min_s, sheet.exposure_nominal_s);
  EXPECT_LE(sheet.exposure_nominal_s, sheet.exposure_max_s);
  EXPECT_GT(sheet.full_well_e, sheet.read_noise_e);
}

TEST_F(Description, SheetNamesTheNearestKeyAndItsLine) {
  const std::string text = Replaced(pmd_, "latency_ms", "latncy_ms");
  ExpectSays(DepthError(text), {"camera.yaml:" + std::to_string(LineOf(text, "latncy_ms")), "latncy_ms: unknown key",
                                "did you mean 'latency_ms'", "missing key 'latency_ms'"});
}

TEST_F(Description, SheetReportsEveryFaultAtOnce) {
  std::string text = Replaced(pmd_, "contrast_at_20mhz: 0.45", "contrast_at_20mhz: 1.45");
  text = Replaced(text, "read_noise_e: 200", "read_noise_e: nan");
  text = Replaced(text, "readout_ms: 1 ", "readout_ms: soon ");
  text = Replaced(text, "frequencies_mhz: [20, 30]", "frequencies_mhz: [20, -30]");
  text = Replaced(text, "width_px: 64 ", "width_px: 64.5 ");
  const std::string error = DepthError(text);
  for (const std::string key : {"contrast_at_20mhz", "read_noise_e", "readout_ms", "frequencies_mhz[1]", "width_px"})
    ExpectSays(error, {"camera.yaml:" + std::to_string(LineOf(text, "\n" + key.substr(0, key.find('['))) + 1) + ": " +
                       key + ": expected"});
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 4);
}

TEST_F(Description, SheetRefusesIntegrationTimesTheWrongWayRound) {
  ExpectSays(DepthError(Replaced(pmd_, "integration_min_us: 100 ", "integration_min_us: 6000 ")),
             {"integration_min_us"});
}

TEST_F(Description, SheetRefusesValuesThatContradictEachOther) {
  const auto expect = [this](const std::string& from, const std::string& to, const std::string& what) {
    const std::string text = Replaced(pmd_, from, to), error = DepthError(text);
    ExpectSays(error, {"camera.yaml:" + std::to_string(LineOf(text, to)) + ":", what});
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
  };
  expect("frequencies_mhz: [20, 30]", "frequencies_mhz: [20, 30, 20.0]", "lists one twice");
  expect("frequencies_mhz: [20, 30]", "frequencies_mhz: []", "expected one frequency at least");
  expect("full_well_e: 1.5e+6", "full_well_e: 200", "full_well_e: is not above read_noise_e");
  // 4 x 0.1 ms and three times 1 ms of read-out are 3.4 ms: 294.1 Hz.
  expect("rate_max_hz: 120", "rate_max_hz: 295",
         "rate_max_hz: the four sub-frames of the shortest exposure take 3.4 ms");
  EXPECT_EQ(DepthError(Replaced(pmd_, "rate_max_hz: 120", "rate_max_hz: 294")), "");
  EXPECT_EQ(DepthError(Replaced(pmd_, "integration_min_us: 100 ", "integration_min_us: 1300 ")), "");
  EXPECT_EQ(DepthError(Replaced(pmd_, "full_well_e: 1.5e+6", "full_well_e: 201")), "");
}

// A value that is wrong on its own is one fault, not two.
TEST_F(Description, WrongValuesContradictNothing) {
  const std::string error = DepthError(Replaced(pmd_, "full_well_e: 1.5e+6", "full_well_e: much"));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
}

TEST_F(Description, SheetSaysWhetherTheChipSuppressesBackgroundLight) {
  EXPECT_FALSE(ReadDepthCameraSheet(File("camera.yaml", Replaced(pmd_, "sbi: true", "sbi: false"))).sbi);
  ExpectSays(DepthError(Replaced(pmd_, "sbi: true", "sbi: 3")), {"sbi: expected true or false, got '3'"});
  ExpectSays(DepthError(Replaced(pmd_, "sbi: true", "sbi: [true]")), {"sbi: expected true or false"});
  ExpectSays(DepthError(Replaced(pmd_, "sbi: true", "# none  ")), {"missing key 'sbi'"});
}

TEST_F(Description, SheetRefusesWhatIsNoSheet) {
  ExpectSays(ErrorOf([] { ReadColorCameraSheet("/nowhere/ccd.yaml"); }), {"/nowhere/ccd.yaml", "cannot be read"});
  ExpectSays(ColorError(""), {"camera.yaml"});
  ExpectSays(ColorError("- 1\n- 2\n"), {"camera.yaml", "map"});
  ExpectSays(ColorError("name: x\nwidth_px: [1\n"), {"camera.yaml:", "YAML"});
  ExpectSays(ColorError(Replaced(ccd_, "fx_px: 780.037", "fx_px: {a: 1}")), {"fx_px: expected"});
  ExpectSays(DepthError(ccd_), {"missing key 'signal_e_m2_per_us'", "fx_px: unknown key"});
}

}  // namespace
}  // namespace merlin
