// The links, joints and shapes that ReadCar takes from a URDF, and the faults that it reports.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <regex>
#include <set>
#include <string>

#include "tests/robot/description/description_fixture.h"

namespace merlin {
namespace {

using namespace car_text;

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

TEST_F(Description, RefusesWhatUrdfdomRefusesAndSaysWhy) {
  testing::internal::CaptureStderr();
  const std::string text = Replaced(merlin_, "<child link=\"pc\"/>", "<child link=\"px\"/>");
  ExpectSays(CarError(text), {"car.urdf:" + std::to_string(LineOf(text, "<joint name=\"pc_joint\"")), "px"});
  ExpectSays(CarError(Replaced(merlin_, "<link name=\"pc\">", "<link name=\"chassis\">")), {"car.urdf", "chassis"});
  ExpectSays(CarError(Replaced(merlin_, "<mass value=\"1.68\"/>", "<mass value=\"heavy\"/>")), {"car.urdf"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // libraries do not print
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

// Wherever a number is expected and none is found, one sentence names the file.
TEST_F(Description, RejectsEveryNumberThatIsNotOne) {
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

}  // namespace
}  // namespace merlin
