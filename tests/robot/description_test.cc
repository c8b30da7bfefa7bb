#include "robot/description/description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "robot/types/error.h"

namespace merlin {
namespace {

namespace fs = std::filesystem;

fs::path Model(const std::string& name) { return fs::path(MERLIN_SOURCE_DIR) / "models" / name; }

std::string Text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The text with the first `from` replaced; from must be there.
std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

int LineOf(const std::string& text, const std::string& part) {
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(part)), '\n'));
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

void ExpectSays(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' not in: " << text;
}

class Description : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "merlin_test_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
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
  std::string ColorError(const std::string& yaml) const {
    return ErrorOf([&] { ReadColorCameraSheet(File("camera.yaml", yaml)); });
  }

  fs::path folder_;
  std::string merlin_ = Text(Model("merlin/merlin.urdf"));
  std::string pmd_ = Text(Model("cameras/pmd_3k_s.yaml"));
  std::string ccd_ = Text(Model("cameras/ccd.yaml"));
};

const CarLink& Link(const CarDescription& car, const std::string& name) {
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
  EXPECT_EQ(Link(car, "front_left_wheel").parent, "front_left_knuckle");
  EXPECT_EQ(Link(car, "front_left_wheel").joint, CarLink::Joint::kContinuous);
  EXPECT_EQ(Link(car, "front_left_knuckle").joint, CarLink::Joint::kRevolute);
  EXPECT_EQ(Link(car, "pc").joint, CarLink::Joint::kFixed);
}

TEST_F(Description, ShapesHaveSizeColourAndMaterial) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  const CarLink& wheel = Link(car, "rear_right_wheel");
  ASSERT_EQ(wheel.collision.size(), 1u);
  EXPECT_EQ(wheel.collision[0].kind, CarShape::Kind::kCylinder);
  EXPECT_EQ(wheel.collision[0].size_m, Eigen::Vector3d(0.055, 0.04, 0.0));
  EXPECT_LT((wheel.collision[0].T_link_shape.linear().col(2).cwiseAbs() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_EQ(wheel.visual[0].material, "car_rubber");
  EXPECT_EQ(wheel.visual[0].rgba, (std::array<float, 4>{0.05f, 0.05f, 0.05f, 1.0f}));
}

TEST_F(Description, DepthCameraLooksAheadLevel) {
  const Pose T_base_depth = ReadCar(Model("merlin/merlin.urdf")).T_base_depth;
  EXPECT_LT((T_base_depth.translation() - Eigen::Vector3d(0.30, 0.0, 0.35)).norm(), 1e-12);
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);  // ahead
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-12);  // right
  EXPECT_LT((T_base_depth.linear() * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);  // down
}

// Table 4.5 of the thesis, read as q_CCD = R q_PMD + t.
TEST_F(Description, ColourCameraStandsWhereTable45Says) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  const Pose T_ccd_pmd = car.T_base_color.inverse() * car.T_base_depth;
  const Eigen::Vector3d rotation_vector(0.05058, 0.07940, -0.01120), translation_mm(14.31872, 63.96501, 70.83500);
  EXPECT_LT((T_ccd_pmd.translation() * 1e3 - translation_mm).norm(), 1e-6);
  EXPECT_LT((LogSo3(T_ccd_pmd.linear()) - rotation_vector).norm(), 1e-9);
  // Above the depth camera and behind it, both looking ahead.
  const Eigen::Vector3d offset_base = car.T_base_color.translation() - car.T_base_depth.translation();
  EXPECT_NEAR(offset_base.z(), 0.064, 0.004);
  EXPECT_NEAR(offset_base.x(), -0.071, 0.004);
  EXPECT_GT(car.T_base_color.linear()(0, 2), 0.99);
}

TEST_F(Description, CompassStandsOnItsMastInTheBodysAxes) {
  const CarDescription car = ReadCar(Model("merlin/merlin.urdf"));
  EXPECT_EQ(car.T_base_compass.linear(), Eigen::Matrix3d::Identity());
  const CarLink& mast = Link(car, "compass_mast");
  EXPECT_NEAR(mast.visual[0].size_m.y(), 0.20, 1e-12);
  const double top_m = mast.T_parent_link.translation().z() + mast.visual[0].T_link_shape.translation().z() + 0.10;
  EXPECT_NEAR(car.T_base_compass.translation().z(), top_m, 0.02);
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

TEST_F(Description, NamesTheLineOfBrokenXml) {
  ExpectSays(CarError("<robot name=\"x\">\n  <link name=\"base_link\">\n</robot>"), {"car.urdf:", "XML"});
  ExpectSays(CarError("<robot name=\"x\">\n  <link name=\"base_link\"/>\n  <link name=\"a\"></lnk>\n</robot>"),
             {"car.urdf:3", "XML"});
}

TEST_F(Description, RefusesACarWithoutWhatItNeeds) {
  ExpectSays(CarError("<robot name=\"x\"><link name=\"body\"/></robot>"), {"car.urdf:1", "base_link", "body"});
  ExpectSays(CarError("<robot name=\"x\"><link name=\"base_link\"/></robot>"), {"front_left_wheel"});
  for (const std::string frame : {"depth_camera_optical_frame", "color_camera_optical_frame", "compass_frame"}) {
    std::string renamed = merlin_;
    for (std::size_t at; (at = renamed.find("\"" + frame + "\"")) != std::string::npos;)
      renamed.replace(at + 1, 1, "X");
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
  const std::string chassis = "<link name=\"chassis\">", wheel = "<link name=\"front_left_wheel\">";
  for (const std::string mass : {"0", "-1", "nan", "inf"})
    expect("<mass value=\"1.68\"/>", "<mass value=\"" + mass + "\"/>", chassis, "mass");
  expect("ixx=\"0.005404\"", "ixx=\"0\"", chassis, "inertia");
  expect("ixx=\"0.005404\"", "ixx=\"9\"", chassis, "inertia");
  expect("size=\"0.35 0.19 0.006\"", "size=\"0.35 0 0.006\"", chassis, "size");
  expect("radius=\"0.055\"", "radius=\"-0.055\"", wheel, "size");
  expect("gear=\"10\"", "gear=\"0\"", "<drivetrain", "'gear'");
  expect("gear=\"10\"", "gear=\"ten\"", "<drivetrain", "'gear'");
  expect("turn=\"512\"", "turn=\"511.5\"", "<drivetrain", "whole number");
  expect("<joint name=\"rear_left_wheel_joint\" type=\"continuous\">",
         "<joint name=\"rear_left_wheel_joint\" type=\"floating\">", "<joint name=\"rear_left_wheel_joint\"", "type");
  expect("<joint name=\"rear_left_wheel_joint\" type=\"continuous\">",
         "<joint name=\"rear_left_wheel_joint\" type=\"fixed\">", "<joint name=\"rear_left_wheel_joint\"", "turn");
}

TEST_F(Description, RefusesWheelsThatDisagree) {
  ExpectSays(CarError(Replaced(merlin_, "xyz=\"0 -0.13 0.055\"", "xyz=\"0 -0.14 0.055\"")),
             {"rear_right_wheel", "centre"});
  ExpectSays(CarError(Replaced(merlin_, "xyz=\"0 0.13 0.055\"", "xyz=\"0.1 0.13 0.055\"")), {"rear", "base_link"});
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
  const std::string box = "<box size=\"0.35 0.19 0.006\"/>";
  File("body.stl", "mesh");
  for (const std::string name : {"body.stl", "package://merlin/body.stl", "./body.stl"}) {
    const fs::path urdf = File("car.urdf", Replaced(merlin_, box, "<mesh filename=\"" + name + "\" scale=\"1 2 3\"/>"));
    const CarDescription car = ReadCar(urdf);
    const CarShape& shape = Link(car, "chassis").visual[0];
    EXPECT_EQ(shape.kind, CarShape::Kind::kMesh);
    EXPECT_TRUE(shape.mesh.is_absolute());
    EXPECT_TRUE(fs::equivalent(shape.mesh, folder_ / "body.stl"));
    EXPECT_EQ(shape.size_m, Eigen::Vector3d(1, 2, 3));
  }
  for (const std::string name : {"none.stl", "package://merlin/none.stl", "package://merlin", "/nowhere/none.stl"}) {
    const std::string text = Replaced(merlin_, box, "<mesh filename=\"" + name + "\"/>");
    ExpectSays(CarError(text), {"car.urdf:" + std::to_string(LineOf(text, "<link name=\"chassis\">")), "missing mesh"});
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
  EXPECT_GT(sheet.low_signal_amplitude_e, 0.0);
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
  EXPECT_EQ(sheet.read_noise_dn, 1.5);
  EXPECT_EQ(sheet.gain_dn_per_e, 0.02);
}

TEST_F(Description, SheetNamesTheNearestKeyAndItsLine) {
  const std::string text = Replaced(pmd_, "latency_ms", "latncy_ms");
  ExpectSays(DepthError(text), {"camera.yaml:" + std::to_string(LineOf(text, "latncy_ms")), "'latncy_ms'",
                                "did you mean 'latency_ms'", "missing key 'latency_ms'"});
}

TEST_F(Description, SheetReportsEveryFaultAtOnce) {
  std::string text = Replaced(pmd_, "contrast_at_20mhz: 0.45", "contrast_at_20mhz: 1.45");
  text = Replaced(text, "read_noise_e: 200", "read_noise_e: nan");
  text = Replaced(text, "readout_ms: 1 ", "readout_ms: soon ");
  text = Replaced(text, "frequencies_mhz: [20, 30]", "frequencies_mhz: [20, -30]");
  text = Replaced(text, "width_px: 64 ", "width_px: 64.5 ");
  const std::string error = DepthError(text);
  for (const std::string key : {"contrast_at_20mhz", "read_noise_e", "readout_ms", "frequencies_mhz", "width_px"})
    ExpectSays(error, {"camera.yaml:" + std::to_string(LineOf(text, "\n" + key) + 1) + ": '" + key + "'"});
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 4);
}

TEST_F(Description, SheetRefusesIntegrationTimesTheWrongWayRound) {
  ExpectSays(DepthError(Replaced(pmd_, "integration_min_us: 100 ", "integration_min_us: 6000 ")),
             {"integration_min_us"});
}

TEST_F(Description, SheetRefusesWhatIsNoSheet) {
  ExpectSays(ErrorOf([] { ReadColorCameraSheet("/nowhere/ccd.yaml"); }), {"/nowhere/ccd.yaml", "cannot be read"});
  ExpectSays(ColorError(""), {"camera.yaml"});
  ExpectSays(ColorError("- 1\n- 2\n"), {"camera.yaml", "map"});
  ExpectSays(ColorError("name: x\nwidth_px: [1\n"), {"camera.yaml:", "YAML"});
  ExpectSays(ColorError(Replaced(ccd_, "fx_px: 780.037", "fx_px: {a: 1}")), {"'fx_px'"});
  ExpectSays(DepthError(ccd_), {"missing key 'signal_e_m2_per_us'", "unknown key 'fx_px'"});
}

}  // namespace
}  // namespace merlin
