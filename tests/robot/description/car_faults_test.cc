// urdfdom drops the rest of a link at the first part it does not understand. No part may vanish without a message.
#include "tests/robot/description/car_text.h"

namespace merlin {
namespace {

using namespace car_text;

constexpr char kBody[] = "<collision><geometry><box size=\"0.6 0.25 0.12\"/></geometry></collision>";

// The rover with this collision shape, on a line of its own, instead of the box of its body.
std::string WithCollision(const std::string& collision) { return Replaced(RoverUrdf(), kBody, "\n" + collision); }

TEST(CarFaults, RefusesAShapeThatUrdfDoesNotKnow) {
  for (const std::string shape : {"capsule", "ellipsoid", "plane", "drake:capsule", "verbose", "Box"})
    for (const std::string in : {"visual", "collision"}) {
      const std::string part =
          "<" + in + ">\n<geometry><" + shape + " radius=\"3\" length=\"0.1\" size=\"1 1 1\"/></geometry></" + in + ">";
      const std::string urdf = WithCollision(kBody + part);
      ExpectFault(urdf, {At(urdf, "<geometry><" + shape), "link 'chassis'", "<" + shape + "> in a <" + in + ">",
                         "expected <box>, <cylinder>, <sphere> or <mesh>"});
    }
}

TEST(CarFaults, RefusesAShapeThatIsNotThere) {
  for (const std::string in : {"visual", "collision"}) {
    const std::string begin = "<" + in + ">", end = "</" + in + ">";
    ExpectFault(WithCollision(begin + "<geometry/>" + end),
                {"car.urdf:3: link 'chassis'", "<geometry> of a <" + in + "> is empty"});
    ExpectFault(WithCollision(begin + end), {"car.urdf:3: link 'chassis'", "<" + in + "> needs a <geometry>"});
    ExpectFault(WithCollision("<" + in + "/>"), {"<" + in + "> needs a <geometry>"});
    ExpectFault(WithCollision(begin + "<geometry><sphere radius=\"1\"/><box size=\"9 9 9\"/></geometry>" + end),
                {"a second shape in one <geometry>: <box>"});
    ExpectFault(
        WithCollision(begin + "<geometry><sphere radius=\"1\"/></geometry><geometry><box size=\"9 9 9\"/></geometry>" +
                      end),
        {"a second <geometry> in one <" + in + ">"});
    ExpectFault(WithCollision(begin + "<box size=\"1 1 1\"/><geometry><sphere radius=\"1\"/></geometry>" + end),
                {"<box> has no meaning in <" + in + ">"});
  }
  ExpectFault(WithCollision("<geometry><sphere radius=\"1\"/></geometry>"), {"<geometry> has no meaning in <link>"});
  ExpectFault(Replaced(RoverUrdf(), "</robot>", std::string(kBody) + "</robot>"),
              {"<collision> has no meaning in <robot>"});
}

TEST(CarFaults, RefusesAShapeWithoutItsSize) {
  const auto expect = [](const std::string& shape, const std::string& says) {
    ExpectFault(WithCollision("<collision><geometry>" + shape + "</geometry></collision>"), {"link 'chassis'", says});
  };
  expect("<box/>", "<box> needs 'size'");
  expect("<sphere/>", "<sphere> needs 'radius'");
  expect("<cylinder radius=\"1\"/>", "<cylinder> needs 'length'");
  expect("<cylinder length=\"1\"/>", "<cylinder> needs 'radius'");
  expect("<mesh/>", "<mesh> needs 'filename'");
  expect("<mesh filename=\"\"/>", "<mesh> needs 'filename'");
  expect("<mesh filename=\"wheel.obj\" scale=\"1 0 1\"/>", "nowhere 0");
}

// A material without a name, or an incomplete <inertia>, makes urdfdom drop everything after it.
TEST(CarFaults, RefusesWhatEndsUrdfdomsReadingOfALink) {
  ExpectFault(WithCollision("<visual><geometry><sphere radius=\"1\"/></geometry><material/></visual>"),
              {"link 'chassis'", "<material> needs 'name'"});
  ExpectFault(WithCollision("<visual><geometry><sphere radius=\"1\"/></geometry><material name=\"m\"><color rgba=\"1 1 "
                            "1 255\"/></material></visual>"),
              {"link 'chassis'", "<color> 'rgba'", "4 numbers from 0 to 1", "'1 1 1 255'"});
  const std::string inertial = Inertial(8.0, 0.15);
  ExpectFault(Replaced(RoverUrdf(), inertial, "<inertial><mass value=\"8\"/></inertial>"),
              {"link 'chassis'", "<inertial> needs a <inertia>"});
  ExpectFault(Replaced(RoverUrdf(), inertial, Replaced(inertial, "<mass value=\"8\"/>", "")),
              {"link 'chassis'", "<inertial> needs a <mass>"});
  ExpectFault(Replaced(RoverUrdf(), inertial, Replaced(inertial, "ixy=\"0\"", "")),
              {"link 'chassis'", "<inertia> needs 'ixy'"});
  ExpectFault(Replaced(RoverUrdf(), inertial, Replaced(inertial, "<mass value=\"8\"/>", "<mass/>")),
              {"link 'chassis'", "<mass> needs 'value'"});
}

TEST(CarFaults, ReadsNumbersWithWhiteSpaceAroundThem) {
  std::string urdf = Replaced(RoverUrdf(), "<mass value=\"8\"/>", "<mass value=\" +8\n\"/>");
  urdf = Replaced(urdf, "size=\"0.6 0.25 0.12\"", "size=\"\t0.6  0.25\n0.12 \"");
  urdf = Replaced(urdf, "scale=\"0.001 0.001 0.001\"", "scale=\" 0.001\t0.001  0.001\"");
  const CarDescription car = Rover(urdf).Read();
  EXPECT_EQ(car.links[1].mass_kg, 8.0);
  EXPECT_EQ(car.links[1].visual.size(), 1u);
  ASSERT_EQ(car.links[1].collision.size(), 1u);
  EXPECT_EQ(car.links[1].collision[0].size_m, Eigen::Vector3d(0.6, 0.25, 0.12));
}

// Simulators, planners and old tools add elements of their own to URDFs, with values of any kind.
TEST(CarFaults, IgnoresElementsThatUrdfDoesNotDefine) {
  std::string urdf = WithCollision(
      "<verbose value=\"Yes\"/><self_collide value=\"\"/><collision><verbose value=\"Yes\"/><contact_coefficients "
      "mu=\"a\" "
      "length=\"b\"/><geometry><box size=\"0.6 0.25 0.12\"/></geometry></collision>");
  urdf = Replaced(urdf, "</robot>",
                  R"(<gazebo reference="chassis"><visual><material>Gazebo/Blue</material></visual><pose xyz="a b c"/>
    <collision/><sensor><origin rpy="soon"/><limit lower="x"/></sensor></gazebo>
    <transmission name="t"><joint name="axle_fl"/><actuator name="m"><mechanicalReduction value="one"/></actuator></transmission>
    <vendor:sensor xmlns:vendor="v" radius="large"><link name="inside"/></vendor:sensor></robot>)");
  const CarDescription car = Rover(urdf).Read();
  const CarDescription plain = Rover(RoverUrdf()).Read();
  ASSERT_EQ(car.links.size(), plain.links.size());
  ASSERT_EQ(car.links[1].collision.size(), 1u);
  EXPECT_EQ(car.links[1].collision[0].size_m, Eigen::Vector3d(0.6, 0.25, 0.12));
  EXPECT_TRUE(car.warnings.empty());
}

TEST(CarFaults, RefusesLeftOversOfXacro) {
  std::string urdf = WithCollision("<xacro:box_collision x=\"1\"/>");
  ExpectFault(urdf, {"car.urdf:3: <xacro:box_collision> is xacro, not URDF", "xacro car.urdf > expanded.urdf"});
  urdf = Replaced(RoverUrdf(), "size=\"0.6 0.25 0.12\"", "size=\"${length} 0.25 0.12\"");
  ExpectFault(urdf, {"car.urdf:2: size=\"${length} 0.25 0.12\" is xacro"});
  urdf = WithCollision("<collision><geometry><xacro:insert_block name=\"shape\"/></geometry></collision>");
  ExpectFault(urdf, {"car.urdf:3: <xacro:insert_block> is xacro"});
  ExpectFault(Replaced(RoverUrdf(), "package://rover/body.dae", "$(arg folder)/body.dae"),
              {"filename=\"$(arg folder)/body.dae\" is xacro"});
  // A processed file still has the namespace.
  EXPECT_EQ(Rover(Replaced(RoverUrdf(), "<robot ", "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" ")).Error(),
            "");
}

TEST(CarFaults, ToldOnceOfAFileThatIsXacroAsAWhole) {
  ExpectFault(
      "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:property name=\"r\" value=\"0.1\"/>\n"
      "<xacro:macro name=\"wheel\" params=\"side\">\n<link name=\"${side}_wheel\"/>\n</xacro:macro>\n<xacro:wheel "
      "side=\"left\"/>\n"
      "<link name=\"a\"><visual/></link>\n</robot>",
      {"car.urdf:2: <xacro:property> is xacro, not URDF (also at line 3, 6)"});
}

TEST(CarFaults, NamesTheLinkThatHasNoMass) {
  const std::string urdf = RoverUrdf();
  ExpectFault(Replaced(urdf, Inertial(8.0, 0.15), ""),
              {At(urdf, "<link name=\"chassis\">"), "link 'chassis' moves: it needs a mass", "<inertial>"});
  const std::string wheel = "<link name=\"wheel_fl\">" + Inertial(0.6, 0.1);
  ExpectFault(Replaced(urdf, wheel, "<link name=\"wheel_fl\">"),
              {At(urdf, "<link name=\"wheel_fl\">"), "link 'wheel_fl' moves"});
  ExpectFault(Replaced(urdf, "<link name=\"knuckle_l\">" + Inertial(0.1, 0.03), "<link name=\"knuckle_l\">"),
              {"link 'knuckle_l' moves"});
  // What is fixed to it may bear it.
  std::string borne = Replaced(urdf, Inertial(8.0, 0.15), "");
  borne = Replaced(borne, "</robot>",
                   "<link name=\"ballast\">" + Inertial(8.0, 0.15) + "</link>" +
                       Joint("b", "fixed", "chassis", "ballast", "") + "</robot>");
  EXPECT_EQ(Rover(borne).Error(), "");
}

TEST(CarFaults, NamesMassesAndInertiasThatNoBodyHas) {
  const std::string urdf = RoverUrdf(), inertial = Inertial(8.0, 0.15);
  const auto expect = [&](const std::string& inertia, const std::string& says) {
    ExpectFault(Replaced(urdf, inertial, "<inertial><mass value=\"8\"/><inertia " + inertia + "/></inertial>"),
                {"car.urdf:2: link 'chassis'", says});
  };
  for (const std::string mass : {"0", "-8"})
    ExpectFault(Replaced(urdf, "<mass value=\"8\"/>", "<mass value=\"" + mass + "\"/>"),
                {"car.urdf:2: link 'chassis': mass; expected a positive number of kg, got " + mass});
  expect(R"(ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0")", "smallest principal inertia");
  expect(R"(ixx="1" iyy="1" izz="1" ixy="2" ixz="0" iyz="0")", "smallest principal inertia");  // 3, 1, -1
  expect(R"(ixx="1" iyy="1" izz="2.1" ixy="0" ixz="0" iyz="0")", "largest principal inertia");
  // A thin plate's, as files with five digits have it: taken for what MuJoCo accepts.
  const std::string plate =
      R"(<inertial><mass value="8"/><inertia ixx="0.12346" iyy="0.12346" izz="0.24693" ixy="0" ixz="0" iyz="0"/></inertial>)";
  const Eigen::Matrix3d inertia = Rover(Replaced(urdf, inertial, plate)).Read().links[1].inertia_kg_m2;
  EXPECT_LE(inertia(2, 2), inertia(0, 0) + inertia(1, 1));
  EXPECT_NEAR(inertia(2, 2), 0.24693, 2e-5);
}

TEST(CarFaults, NamesJointsThatACarCannotHave) {
  const std::string urdf = RoverUrdf(), imu = "<joint name=\"imu_joint\" type=\"fixed\">";
  for (const std::string type : {"floating", "planar", "spherical", "Fixed"}) {
    const std::string changed = Replaced(urdf, imu, "<joint name=\"imu_joint\" type=\"" + type + "\">");
    ExpectFault(changed, {At(changed, "<joint name=\"imu_joint\""), "joint 'imu_joint': type", "got '" + type + "'"});
  }
  ExpectFault(Replaced(urdf, imu, "<joint name=\"imu_joint\">"), {"joint 'imu_joint'", "<joint> needs 'type'"});
  ExpectFault(Replaced(urdf, imu, "<joint name=\"imu_joint\" type=\"revolute\">"),
              {"joint 'imu_joint'", "a revolute joint needs a <limit>"});
  ExpectFault(Replaced(urdf, "<child link=\"imu\"/>", "<child link=\"imo\"/>"),
              {"joint 'imu_joint'", "child link 'imo' is not in the file; did you mean 'imu'?"});
}

TEST(CarFaults, NamesLinksAndJointsThatAreNotOneTree) {
  const std::string urdf = RoverUrdf();
  ExpectFault(Replaced(urdf, "<link name=\"imu\"/>", "<link name=\"imu\"/><link name=\"stray\"/>"),
              {"link 'stray': a second root beside 'chassis'"});
  ExpectSays(Rover(Replaced(urdf, "<link name=\"imu\"/>", "<link name=\"imu\"/>\n<link name=\"imu\"/>")).Error(),
             {"link 'imu': the name is given twice, first in line"});
  ExpectSays(Rover(Replaced(urdf, "<link name=\"imu\"/>", "<link name=\"imu\"/>\n<link/>")).Error(),
             {"<link> needs 'name'"});
  ExpectSays(Rover(Replaced(urdf, "<link name=\"imu\"/>", "<link name=\"imu\"/><link name=\"world\"/>")).Error(),
             {"link 'world': the name is the simulation's own"});
}

TEST(CarFaults, NamesEveryFaultWithItsLine) {
  std::string urdf = WithCollision("<collision><geometry><capsule radius=\"1\" length=\"1\"/></geometry></collision>");
  urdf = Replaced(urdf, "<mass value=\"0.1\"/>", "<mass value=\"0\"/>");
  urdf = Replaced(urdf, "<link name=\"tof\"/>",
                  "<link name=\"tof\"><visual><geometry><mesh filename=\"none.stl\"/></geometry></visual></link>");
  urdf = Replaced(urdf, "<link name=\"eye\"/>",
                  "<link name=\"eye\"><visual><origin xyz=\"0 0\"/><geometry/></visual></link>");
  const std::string text = Rover(urdf).Error();
  ExpectSays(text, {At(urdf, "<capsule") + "link 'chassis': <capsule>",
                    At(urdf, "<mass value=\"0\"/>") + "link 'knuckle_r': mass",
                    At(urdf, "none.stl") + "link 'tof': missing mesh 'none.stl'", "link 'eye': <origin> 'xyz'",
                    "link 'eye': the <geometry> of a <visual> is empty"});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
}

TEST(CarFaults, IgnoresByteOrderMarks) {
  const std::string bom = "\xEF\xBB\xBF";
  EXPECT_EQ(Rover(bom + RoverUrdf(), bom + kRoverMapping).Error(), "");
  EXPECT_EQ(Rover(bom + "<?xml version=\"1.0\"?>\n" + RoverUrdf(), bom + kRoverMapping).Error(), "");
}

}  // namespace
}  // namespace merlin
