// In every room the car touches what its cameras see, and behaves the same.
#include "sim/world/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "robot/base/error.h"
#include "sim/world/room.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

constexpr double kSamePath_m = 1e-3;

const Materials& Curtains() {
  static const Materials materials{.fallback = {}, .by_name = {{"cloth", {.passable = true}}, {"wall", {}}}};
  return materials;
}

std::unique_ptr<World> WorldOf(const std::string& room, const Pose& T_world_start = Pose::Identity()) {
  const TemporaryFile file("room.xml", room);
  WorldOptions options;
  options.room = file.path();
  options.car = Merlin();
  options.T_world_start = T_world_start;
  options.materials = Curtains();
  return std::make_unique<World>(options);
}

std::string ErrorOf(const std::string& room) {
  try {
    WorldOf(room);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void ExpectSays(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

// Drives a bend at 1 m/s, then straight into the wall at x = 1.5 m, then back: wheels roll and slip, the bumper pushes.
constexpr char kWall[] = R"(<geom name="wall" type="box" pos="1.55 0 .5" size=".05 3 .5"/>)";

std::vector<Eigen::Vector3d> PathIn(const std::string& room) {
  const auto world = WorldOf(room);
  std::vector<Eigen::Vector3d> path;
  const auto drive = [&](double speed_m_s, double steering_rad, double duration_s) {
    Send(*world, speed_m_s, steering_rad);
    for (const Time end = world->Now() + FromSeconds(duration_s); world->Now() < end;) {
      world->Step();
      path.push_back(world->T_world_base().translation());
    }
  };
  drive(1.0, 0.2, 0.6);
  drive(1.0, -0.1, 1.0);
  drive(-0.5, 0.3, 0.4);
  return path;
}

const std::vector<Eigen::Vector3d>& PlainPath() {
  static const std::vector<Eigen::Vector3d> path = PathIn(Room(std::string(kPlane) + kWall));
  return path;
}

void ExpectPlainPath(const std::string& room) {
  const std::vector<Eigen::Vector3d> path = PathIn(room);
  ASSERT_EQ(path.size(), PlainPath().size());
  double worst_m = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) worst_m = std::max(worst_m, (path[i] - PlainPath()[i]).norm());
  EXPECT_LT(worst_m, kSamePath_m) << room;
}

// How far the front gets in 4 s ahead at 0.5 m/s. The car's front is 0.45 m ahead of its base.
double FrontAfterDriving_m(const World& world) { return world.T_world_base().translation().x() + 0.45; }

double FrontIn_m(const std::string& worldbody, const std::string& rest = "") {
  const auto world = WorldOf(Room(kPlane + worldbody, rest));
  Send(*world, 0.5, 0.0);
  StepFor(*world, 4.0);
  return FrontAfterDriving_m(*world);
}
constexpr double kFree_m = 2.3;  // the front gets at least this far if nothing stops it

TEST(Solid, TheUsualPathTouchesTheWall) {
  double most_m = 0.0;
  for (const Eigen::Vector3d& p : PlainPath()) most_m = std::max(most_m, p.x());
  EXPECT_NEAR(most_m + 0.45, 1.5, 0.03);
}

TEST(Solid, FloorsOfAnyContactBitsCarryTheCar) {
  for (const char* bits : {"contype='0' conaffinity='1'", "contype='0' conaffinity='0'", "contype='4' conaffinity='4'",
                           "contype='1' conaffinity='0'", "contype='0' conaffinity='2'", "contype='2' conaffinity='0'",
                           "contype='-2147483648' conaffinity='0'", "contype='0' conaffinity='0' group='1'",
                           "contype='0' conaffinity='0' group='4'"}) {
    ExpectPlainPath(Room(fmt::format("<geom name='floor' type='plane' size='0 0 1' {}/>{}", bits, kWall)));
  }
  ExpectPlainPath(Room(std::string(kPlane) + kWall, "<default><geom contype='4' conaffinity='4'/></default>"));
  ExpectPlainPath(Room(std::string("<body childclass='off'>") + kPlane + kWall + "</body>",
                       "<default><default class='off'><geom contype='0' conaffinity='0'/></default></default>"));
}

TEST(Solid, ContactValuesOfTheRoomDoNotAffectTheCar) {
  for (const char* values :
       {"margin='.02'", "gap='.02'", "margin='.02' gap='.01'", "priority='5'", "priority='2147483647'", "condim='1'",
        "condim='6' friction='3 2 2'", "friction='.05'", "priority='3' friction='.01 0 0' condim='4'", "solref='.2 .3'",
        "solref='-50 -5' priority='2'", "solimp='.1 .2 .05'", "solmix='1000' solref='.5 1'", "adhesion='50'",
        "surfacevel='1 0 0 0 0 0'", "mass='1e6'", "fluidshape='ellipsoid'"})
    ExpectPlainPath(Room(std::string(kPlane) + kWall, fmt::format("<default><geom {}/></default>", values)));
}

TEST(Solid, NothingElseInARoomChangesTheCar) {
  for (const char* rest :
       {"<compiler boundmass='1' boundinertia='.1'/>", "<compiler settotalmass='100' inertiafromgeom='true'/>",
        "<compiler balanceinertia='true' autolimits='false' angle='radian' eulerseq='ZYX' alignfree='true'/>",
        "<compiler inertiagrouprange='3 3' discardvisual='true' fusestatic='true'/>",
        "<option gravity='0 0 -1' wind='30 0 0' density='1000' viscosity='5' timestep='.01' cone='pyramidal'/>",
        "<option o_margin='.05' o_solref='.5 1' o_friction='.1 .1 .1 .1 .1'><flag override='enable'/></option>",
        "<option impratio='1' tolerance='1' iterations='1' solver='PGS'><flag contact='disable' "
        "gravity='disable'/></option>",
        "<option actuatorgroupdisable='0'><flag actuation='disable' equality='disable' limit='disable'/></option>",
        "<size memory='20K'/>", "<size nconmax='2'/>", "<size njmax='3' />", "<statistic meansize='1' extent='1'/>",
        "<size nuser_geom='2' nuser_body='1' nuser_jnt='3' nuser_actuator='1'/>",
        "<keyframe><key name='home'/></keyframe>",
        "<default><joint damping='9' armature='9' frictionloss='2' stiffness='4' limited='true' range='0 1' "
        "actuatorgravcomp='true'/></default>",
        "<default><tendon frictionloss='5' damping='4'/><equality solref='.5 1' active='false'/></default>",
        "<default><general gear='5' ctrlrange='-1 1' forcerange='-.1 .1' dyntype='integrator'/><motor "
        "gear='9'/></default>",
        "<default><mesh scale='2 2 2' maxhullvert='4'/><material rgba='1 0 0 0'/><site group='1'/><pair "
        "margin='1'/></default>",
        "<visual><global offwidth='10'/><map znear='2'/></visual>"})
    ExpectPlainPath(Room(std::string(kPlane) + kWall, rest));
}

TEST(Solid, AMovingBodyFarAwayAndItsKeyframeLeaveTheCarAlone) {
  ExpectPlainPath(Room(
      std::string(kPlane) + kWall +
          "<body pos='-8 0 1'><joint name='hinge' axis='0 0 1'/><geom name='door' type='box' size='.5 .02 1'/></body>"
          "<body pos='-8 5 1'><freejoint/><geom type='sphere' size='.1' mass='500' condim='6'/></body>",
      "<keyframe><key qpos='1 -8 5 1 1 0 0 0' ctrl='3'/></keyframe>"
      "<actuator><motor name='opener' joint='hinge'/></actuator>"
      "<compiler boundmass='2'/>"));
}

TEST(Solid, KeepsTheMassesOfTheRoomsOwnBodies) {
  const std::string body =
      "<body name='ball' pos='-5 0 1'><freejoint/><geom size='.1' pos='.2 0 0' density='100'/></body>";
  const auto mass = [&](const std::string& compiler) {
    const auto world = WorldOf(Room(kPlane + body, compiler));
    return world->model()->body_mass[mj_name2id(world->model(), mjOBJ_BODY, "ball")];
  };
  const double ball_kg = 100 * 4.0 / 3.0 * std::numbers::pi * 1e-3;
  EXPECT_NEAR(mass(""), ball_kg, 1e-9);
  EXPECT_NEAR(mass("<compiler boundmass='3'/>"), 3.0, 1e-9);
  EXPECT_NEAR(mass("<compiler settotalmass='7'/>"), 7.0, 1e-9);
}

TEST(Solid, RefusesARoomThatNamesPartsOfTheCar) {
  ExpectSays(ErrorOf(Room(kPlane, "<contact><exclude body1='base_link' body2='world'/></contact>")), "base_link");
  ExpectSays(ErrorOf(Room(kPlane, "<contact><pair geom1='floor' geom2='wheel_rear_left_collision_0'/></contact>")),
             "wheel_rear_left_collision_0");
}

TEST(Solid, VisualGeomsStopTheCarWhereTheyAreSeen) {
  for (const char* shape :
       {"type='box' size='.05 1 .3' pos='1.55 0 .3'", "type='cylinder' size='.2 .5' pos='1.7 0 .5'",
        "type='sphere' size='.4' pos='1.9 0 .1'", "type='capsule' fromto='1.6 -1 .1 1.6 1 .1' size='.1'",
        "type='ellipsoid' size='.1 1 1' pos='1.6 0 .1'", "type='plane' size='1 1 1' pos='1.5 0 .5' zaxis='-1 0 0'",
        "type='plane' size='0 0 1' pos='1.5 0 0' zaxis='-1 0 0'"})
    EXPECT_NEAR(FrontIn_m(fmt::format("<geom {} contype='0' conaffinity='0' group='2'/>", shape)), 1.5, 0.03) << shape;
}

TEST(Solid, UnseenAndPassableGeomsDoNotStopTheCar) {
  const char* visual = "<geom type='box' size='.05 1 .3' pos='1.55 0 .3' contype='0' conaffinity='0' {}/>";
  const std::string assets = "<asset><material name='cloth'/><material name='air' rgba='1 1 1 0'/></asset>";
  for (const char* what : {"group='3'", "rgba='1 1 1 0'", "material='cloth'", "material='air'"})
    EXPECT_GT(FrontIn_m(fmt::format(fmt::runtime(visual), what), assets), kFree_m) << what;
  EXPECT_LT(FrontIn_m(fmt::format(fmt::runtime(visual), "rgba='1 1 1 .1'"), assets), 1.53);
  // Its own contacts count, whatever the material is.
  EXPECT_LT(FrontIn_m("<geom type='box' size='.05 1 .3' pos='1.55 0 .3' material='cloth'/>", assets), 1.53);
}

TEST(Solid, APanelEndsWhereItIsSeenToEnd) {
  for (const char* bits : {"", "contype='0' conaffinity='0'"}) {
    EXPECT_GT(FrontIn_m(fmt::format("<geom type='plane' size='.5 .5 1' pos='1.5 2 .5' zaxis='-1 0 0' {}/>", bits)),
              kFree_m);
    EXPECT_NEAR(FrontIn_m(fmt::format("<geom type='plane' size='.5 .5 1' pos='1.5 .2 .5' zaxis='-1 0 0' {}/>", bits)),
                1.5, 0.03);
  }
  // The top of a table as a visual plane, 0.7 m high: the car passes below it.
  EXPECT_GT(FrontIn_m("<geom type='plane' size='.5 .5 1' pos='1.5 0 .7' contype='0' conaffinity='0'/>"), kFree_m);
}

int CarContactBits(const std::string& worldbody, const char* geom, const std::string& rest = "") {
  const auto world = WorldOf(Room(kPlane + worldbody, rest), FromXyYaw(-5, 0, 0));
  return world->model()->geom_contype[mj_name2id(world->model(), mjOBJ_GEOM, geom)] & kMeetsCar;
}

TEST(Solid, GeomsThatCoverAVisualGeomStandInForIt) {
  const std::string seen = "<geom name='seen' type='box' size='.02 1 .5' pos='0 0 .5' contype='0' conaffinity='0'/>";
  // Its faces are at x = +-0.02 m. Each line says how far the face of the other geom is behind the near one.
  EXPECT_FALSE(CarContactBits(seen + "<geom type='box' size='.1 1 .5' pos='.12 0 .5'/>", "seen"));  // 4 cm
  EXPECT_TRUE(CarContactBits(seen + "<geom type='box' size='.1 1 .5' pos='.14 0 .5'/>", "seen"));   // 6 cm
  EXPECT_TRUE(CarContactBits(seen + "<geom type='box' size='.1 .5 .5' pos='.1 .5 .5'/>", "seen"));  // covers half of it
  EXPECT_TRUE(
      CarContactBits(seen + "<geom type='sphere' size='.04' pos='0 0 .5'/>", "seen"));  // covers one point of it
  EXPECT_TRUE(CarContactBits(seen + "<geom type='box' size='.1 .4 .5' pos='0 .55 .5'/>"
                                    "<geom type='box' size='.1 .4 .5' pos='0 -.55 .5'/>",
                             "seen"));  // a gap of 0.3 m
  EXPECT_FALSE(CarContactBits(seen + "<geom type='box' size='.1 .5 .5' pos='0 .5 .5'/>"
                                     "<geom type='box' size='.1 .5 .5' pos='0 -.5 .5'/>",
                              "seen"));  // two halves
  EXPECT_FALSE(CarContactBits(seen + "<geom type='box' size='.02 1 .5' pos='0 0 .5' group='3'/>", "seen"));
  EXPECT_TRUE(CarContactBits(
      seen + "<geom type='box' size='.02 1 .5' pos='0 0 .5' group='3' contype='0' conaffinity='0'/>", "seen"));
}

TEST(Solid, StandInsForAVisualGeomTouchTheCar) {
  const char* room =
      "<geom type='box' size='.05 1 .3' pos='1.55 0 .3' contype='0' conaffinity='0'/>"
      "<geom name='for' type='box' size='.05 1 .3' pos='1.55 0 .3' group='3' contype='{0}' conaffinity='{0}'/>";
  for (const int bits : {1, 2, 4, 8}) EXPECT_NEAR(FrontIn_m(fmt::format(fmt::runtime(room), bits)), 1.5, 0.03) << bits;
  // An invisible geom with other bits, which stands in for nothing, is not a wall.
  EXPECT_GT(FrontIn_m("<geom type='box' size='.05 1 .3' pos='1.55 0 .3' group='3' contype='4' conaffinity='4'/>"),
            kFree_m);
}

TEST(Solid, AFloorStandsInForAMatButNotForAKerb) {
  const auto board = [](double height_m) {
    return fmt::format("<geom name='seen' type='box' size='.5 1 {0}' pos='2 0 {0}' contype='0' conaffinity='0'/>",
                       height_m / 2);
  };
  EXPECT_FALSE(CarContactBits(board(0.002), "seen"));
  EXPECT_FALSE(CarContactBits(board(0.015), "seen"));
  EXPECT_TRUE(CarContactBits(board(0.04), "seen"));
}

TEST(Solid, OnlyGeomsThatMoveWithAGeomStandInForIt) {
  const std::string wall = "<geom type='box' size='1 .1 1' pos='0 0 1'/>";
  const char* leaf = "<geom name='seen' type='box' size='.5 .02 1' pos='.5 0 1' contype='0' conaffinity='0'/>";
  EXPECT_FALSE(CarContactBits(wall + "<body>" + leaf + "</body>", "seen"));
  EXPECT_TRUE(
      CarContactBits(wall + "<body><joint axis='0 0 1'/><geom size='.01' pos='0 0 3'/>" + leaf + "</body>", "seen"));
  // Shapes of one body belong together: 6 cm along x and z is near enough.
  const std::string shape = "<geom type='box' size='.44 .02 .94' pos='.5 0 1'/>";
  EXPECT_FALSE(CarContactBits(std::string("<body><joint axis='0 0 1'/>") + shape + leaf + "</body>", "seen"));
  EXPECT_TRUE(CarContactBits(shape + leaf, "seen"));
}

// Vertices of a box between these corners for MJCF, and its faces, with vertices numbered from this one.
std::string BoxVertices(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += fmt::format("{} {} {} ", (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z());
  return text;
}
std::string BoxFaces(int first) {
  std::string text;
  for (const int corner :
       {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5})
    text += fmt::format("{} ", corner + first);
  return text;
}
std::string Mesh(const std::string& vertices, const std::string& faces) {
  return fmt::format("<asset><mesh name='shell' inertia='shell' vertex='{}' face='{}'/></asset>", vertices, faces);
}
// Two walls, at x = 1.5 and x = -1.5 m, in one mesh.
std::string TwoWalls() {
  return Mesh(BoxVertices({1.5, -2, 0}, {1.6, 2, 1}) + BoxVertices({-1.6, -2, 0}, {-1.5, 2, 1}),
              BoxFaces(0) + BoxFaces(8));
}

TEST(Solid, AMeshCollidesAsItIs) {
  for (const char* bits : {"", "contype='0' conaffinity='0'", "contype='4' conaffinity='4'", "margin='.05'"}) {
    const auto world =
        WorldOf(Room(kPlane + fmt::format("<geom name='walls' type='mesh' mesh='shell' {}/>", bits), TwoWalls()));
    EXPECT_TRUE(world->CarTouches().empty());
    Send(*world, 0.5, 0.0);
    std::string touched;
    while (world->Now() < FromSeconds(4.0)) {
      world->Step();
      if (!world->CarTouches().empty()) touched = world->CarTouches()[0].other_geom;
    }
    EXPECT_NEAR(FrontAfterDriving_m(*world), 1.5, 0.03) << bits;
    EXPECT_EQ(touched, "walls");
    EXPECT_TRUE(world->warnings().empty());
  }
}

TEST(Solid, AnOpenShellIsSolidFromBothSides) {
  // The four upright faces of a room of 3 x 3 m, no floor and no ceiling, facing out or in.
  const std::string vertices = BoxVertices({-1.5, -1.5, 0}, {1.5, 1.5, 1});
  for (const char* faces :
       {"0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5", "0 5 1 0 4 5 2 7 6 2 3 7 0 6 4 0 2 6 1 7 3 1 5 7"})
    for (const char* bits : {"", "contype='0' conaffinity='0'"})
      EXPECT_NEAR(FrontIn_m(fmt::format("<geom type='mesh' mesh='shell' {}/>", bits), Mesh(vertices, faces)), 1.5, 0.03)
          << faces;
}

TEST(Solid, AShellMayHaveAFloorOfItsOwnOnTheFloor) {
  // Inside out: a room of 3 x 3 x 1 m with floor and ceiling, its floor 1 mm above and below the plane.
  for (const double z_m : {-0.001, 0.0, 0.001}) {
    std::string faces;
    for (const int corner :
         {0, 3, 2, 0, 1, 3, 4, 7, 5, 4, 6, 7, 0, 5, 1, 0, 4, 5, 2, 7, 6, 2, 3, 7, 0, 6, 4, 0, 2, 6, 1, 7, 3, 1, 5, 7})
      faces += fmt::format("{} ", corner);
    EXPECT_NEAR(
        FrontIn_m("<geom type='mesh' mesh='shell'/>", Mesh(BoxVertices({-1.5, -1.5, z_m}, {1.5, 1.5, 1}), faces)), 1.5,
        0.03)
        << z_m;
  }
}

TEST(Solid, StandInsForAFloorAreFloors) {
  for (const char* group : {"3", "0"})
    ExpectPlainPath(
        Room(fmt::format("<geom name='ground' type='plane' size='0 0 1' group='{}'/>"
                         "<geom name='floor' type='plane' size='9 9 1' contype='0' conaffinity='0'/>{}",
                         group, kWall)));
}

// A rough sheet of n x n cells in which no two triangles lie in one plane.
std::string Scan(int n) {
  std::string vertices, faces;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k)
      vertices += fmt::format("{} {} {} ", 3 + 0.2 * std::sin(1.7 * i * i + 2.3 * k), 4.0 * i / n - 2, 2.0 * k / n);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const int a = i * (n + 1) + k, b = a + n + 1;
      faces += fmt::format("{} {} {} {} {} {} ", a, b, b + 1, a, b + 1, a + 1);
    }
  return Mesh(vertices, faces);
}

TEST(Solid, SaysWhichMeshCollidesAsItsHullAndRefusesOneThatIsOnlySeen) {
  const std::string scan = Scan(40);  // 3200 triangles
  const auto world = WorldOf(Room(std::string(kPlane) + "<geom name='scan' type='mesh' mesh='shell'/>", scan));
  ASSERT_EQ(world->warnings().size(), 1u);
  ExpectSays(world->warnings()[0], "'scan' collides as its convex hull");
  const std::string text = ErrorOf(
      Room(std::string(kPlane) + "<geom name='scan' type='mesh' mesh='shell' contype='0' conaffinity='0'/>", scan));
  ExpectSays(text, "room.xml");
  ExpectSays(text, "geom 'scan' is seen but cannot be made solid");
}

TEST(Solid, SaysWhyTheCarCannotStartInAHull) {
  const std::string text =
      ErrorOf(Room(std::string(kPlane) + "<geom name='scan' type='mesh' mesh='shell' pos='-3 0 0'/>", Scan(40)));
  ExpectSays(text, "cannot start");
  ExpectSays(text, "'scan' collides as its convex hull");
}

TEST(Solid, OurRoomsGiveNoWarnings) {
  for (const char* room : {"corridor_26x21", "bend_10"}) {
    WorldOptions options;
    options.room = std::string(MERLIN_SOURCE_DIR) + "/models/rooms/" + room + ".xml";
    options.car = Merlin();
    options.T_world_start = FromXyYaw(0, room[0] == 'c' ? -9.5 : 0.0, 0);
    EXPECT_TRUE(World(options).warnings().empty()) << room;
  }
}

}  // namespace
}  // namespace merlin::sim
