#include "sim/rays/ray_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "robot/base/error.h"
#include "robot/base/random.h"

namespace merlin::sim {
namespace {

// A model and its state, from text or file.
struct Mujoco {
  mjModel* model = nullptr;
  mjData* data = nullptr;

  explicit Mujoco(mjSpec* spec) : model(spec ? mj_compile(spec, nullptr) : nullptr) {
    if (model) {
      data = mj_makeData(model);
      mj_forward(model, data);
    }
    mj_deleteSpec(spec);
  }
  ~Mujoco() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  Mujoco(const Mujoco&) = delete;
  Mujoco& operator=(const Mujoco&) = delete;

  int Geom(const char* name) const { return mj_name2id(model, mjOBJ_GEOM, name); }
  int Body(const char* name) const { return mj_name2id(model, mjOBJ_BODY, name); }
  std::vector<bool> SkipNothing() const { return std::vector<bool>(static_cast<std::size_t>(model->nbody), false); }
};

mjSpec* Parse(const std::string& xml) {
  char error[1000] = "";
  mjSpec* spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof(error));
  EXPECT_NE(spec, nullptr) << error;
  return spec;
}

mjSpec* ParseFile(const std::filesystem::path& file) {
  char error[1000] = "";
  mjSpec* spec = mj_parseXML(file.c_str(), nullptr, error, sizeof(error));
  EXPECT_NE(spec, nullptr) << error;
  return spec;
}

RayHit CastOne(const RayScene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3f& direction,
               float max_range_m = 100.0f) {
  const std::vector<Ray> rays{{origin.cast<float>(), direction, max_range_m}};
  std::vector<RayHit> hits(1);
  scene.Cast(rays, hits);
  return hits[0];
}

// All shapes, rotated and shifted, two of them on moving bodies; planes finite, infinite and tilted.
constexpr char kShapes[] = R"(
<mujoco>
  <compiler angle="radian"/>
  <asset>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1  1 1 .5"/>
  </asset>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 1"/>
    <geom name="slope" type="plane" size="0 0 1" pos="0 14 0" euler="1.1 .2 .3"/>
    <geom name="panel" type="plane" size="2 1 1" pos="-9 0 1.5" euler="0 1.5 0"/>
    <geom name="sphere" type="sphere" size=".7" pos="3 1 1"/>
    <geom name="capsule" type="capsule" size=".3 .6" pos="-3 2 1" euler=".4 .5 .6"/>
    <geom name="cylinder" type="cylinder" size=".5 .8" pos="1 -4 1" euler="1 .5 -.6"/>
    <geom name="ellipsoid" type="ellipsoid" size=".3 .6 1" pos="-2 -3 1.2" euler=".4 -.5 .6"/>
    <geom name="box" type="box" size=".3 .6 1" pos="5 -3 1.2" euler=".2 -.5 .9"/>
    <geom name="thin" type="box" size="4 .01 1" pos="0 8 1.2" euler="0 0 .1"/>
    <geom name="wedge" type="mesh" mesh="wedge" pos="4 4 .5" euler=".1 .2 .3"/>
    <body name="shelf" pos="-5 -5 0" euler="0 0 .7">
      <geom name="board" type="box" size=".5 .2 .02" pos="0 0 1"/>
    </body>
    <body name="cart" mocap="true" pos="7 0 1" euler=".1 .2 .3">
      <geom name="cart_box" type="box" size=".4 .3 .2"/>
      <geom name="cart_ball" type="sphere" size=".3" pos="0 0 .6"/>
      <body name="rider" pos="0 .8 0"><geom name="rider" type="capsule" size=".1 .3"/></body>
    </body>
    <body name="pole" pos="-7 3 0">
      <joint name="hinge" axis="0 0 1"/>
      <geom name="arm" type="box" size="1 .05 .05" pos="1 0 1"/>
      <geom name="hand" type="mesh" mesh="wedge" pos="2 0 1"/>
    </body>
  </worldbody>
</mujoco>)";

// Box of ray origins: around the finite geoms, from just above the ground to below the upper edges of the walls.
Eigen::AlignedBox3d Surroundings(const Mujoco& world) {
  Eigen::AlignedBox3d box;
  for (int g = 0; g < world.model->ngeom; ++g) {
    if (world.model->geom_type[g] == mjGEOM_PLANE) continue;
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R(world.data->geom_xmat + 9 * g);
    const Eigen::Vector3d centre =
        Eigen::Vector3d(world.data->geom_xpos + 3 * g) + R * Eigen::Vector3d(world.model->geom_aabb + 6 * g);
    const Eigen::Vector3d half = R.cwiseAbs() * Eigen::Vector3d(world.model->geom_aabb + 6 * g + 3);
    box.extend(Eigen::AlignedBox3d(centre - half, centre + half));
  }
  if (box.isEmpty())
    box.extend(Eigen::AlignedBox3d(Eigen::Vector3d(-5, -5, 0), Eigen::Vector3d(5, 5, 2)));  // only planes
  box.min().z() = 0.02;
  box.max().z() = 2.0;
  return box;
}

constexpr double kReach_m = 100.0;
constexpr mjtByte kSeenGroups[mjNGROUP] = {1, 1, 1, 0, 0, 0};

struct OracleHit {
  double range_m = -1.0;
  int geom = -1;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

OracleHit Oracle(const Mujoco& world, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  OracleHit hit;
  hit.range_m = mj_ray(world.model, world.data, origin.data(), direction.data(), kSeenGroups, 1, -1, &hit.geom,
                       hit.normal.data());
  return hit;
}

// Whether a surface begins, ends or folds within 1 mrad of the ray: one of 16 rays on that cone hits another geom, or
// the same geom off the plane that the ray hits.
bool IsNearEdge(const Mujoco& world, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const OracleHit middle = Oracle(world, origin, direction);
  const Eigen::Vector3d u = direction.unitOrthogonal(), v = direction.cross(u);
  for (int i = 0; i < 16; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 16;
    const Eigen::Vector3d tilted = (direction + 1e-3 * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
    const OracleHit hit = Oracle(world, origin, tilted);
    if (hit.geom != middle.geom) return true;
    const Eigen::Vector3d step = hit.range_m * tilted - middle.range_m * direction;
    if (std::abs(middle.normal.dot(step)) > 1e-6) return true;
  }
  return false;
}

bool IsFlat(const Mujoco& world, int geom) {
  const int type = geom < 0 ? -1 : world.model->geom_type[geom];
  return type == mjGEOM_PLANE || type == mjGEOM_BOX || type == mjGEOM_MESH;
}

// 100 origins with 100 rays each, at random positions (also inside geoms) in random directions.
void ExpectAgreement(const Mujoco& world, const RayScene& scene, const std::string& name) {
  constexpr int kOrigins = 100, kRays = 100;
  const Eigen::AlignedBox3d box = Surroundings(world);
  int flat = 0, flat_exact = 0, curved = 0;
  for (int o = 0; o < kOrigins; ++o) {
    Random random(1, Sensor::kDepth, static_cast<std::uint64_t>(o));
    const Eigen::Array3d share(random.Uniform(), random.Uniform(), random.Uniform());
    // Only numbers that a float can hold, so that Embree and the oracle get the same rays.
    const Eigen::Vector3d origin =
        (box.min().array() + share * box.sizes().array()).matrix().cast<float>().cast<double>();
    std::vector<Ray> rays;
    std::vector<double> vectors;
    for (int i = 0; i < kRays; ++i) {
      rays.push_back({origin.cast<float>(),
                      Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()).normalized().cast<float>()});
      for (int k = 0; k < 3; ++k) vectors.push_back(rays.back().direction[k]);
    }
    std::vector<RayHit> hits(kRays);
    scene.Cast(rays, hits);
    std::vector<int> geoms(kRays);
    std::vector<double> ranges(kRays), normals(3 * kRays);
    mj_multiRay(world.model, world.data, origin.data(), vectors.data(), kSeenGroups, 1, -1, geoms.data(), ranges.data(),
                normals.data(), kRays, kReach_m);

    for (std::size_t i = 0; i < kRays; ++i) {
      const Eigen::Vector3d direction = rays[i].direction.cast<double>();
      const std::string what = name + ", origin " + std::to_string(o) + ", ray " + std::to_string(i);
      if (ranges[i] > kReach_m) geoms[i] = -1;  // mj_multiRay's cutoff does not hold for planes
      const bool both_see = hits[i].geom >= 0 && geoms[i] >= 0;
      const double difference_m =
          both_see ? std::abs(hits[i].range_m - ranges[i]) : (hits[i].geom == geoms[i] ? 0 : 1e9);
      if (geoms[i] < 0 && hits[i].geom < 0) continue;
      if (IsFlat(world, geoms[i]) || !both_see) {
        ++flat;
        flat_exact += difference_m <= 1e-4;
        if (difference_m > 1e-4) {
          EXPECT_TRUE(IsNearEdge(world, origin, direction)) << what << ": off by " << difference_m << " m";
          continue;
        }
      } else {
        ++curved;
        // The rim of a curved geom is an edge as well.
        if (difference_m > 2e-3) {
          EXPECT_TRUE(IsNearEdge(world, origin, direction) && hits[i].geom != geoms[i])
              << what << ": off by " << difference_m;
          continue;
        }
      }
      if (hits[i].geom != geoms[i]) continue;  // two geoms in one place
      Eigen::Vector3d normal(normals.data() + 3 * i);
      if (normal.dot(direction) > 0.0) normal = -normal;
      EXPECT_LE(hits[i].normal.dot(rays[i].direction), 0.0f) << what;
      EXPECT_NEAR(hits[i].normal.norm(), 1.0f, 1e-5f) << what;
      if ((hits[i].normal.cast<double>() - normal).norm() > 5e-3) {
        EXPECT_TRUE(IsNearEdge(world, origin, direction)) << what << ": normal " << hits[i].normal.transpose();
      }
    }
  }
  EXPECT_GE(flat_exact, 0.999 * flat) << name;
  // In a room at least half of the rays hit something; over a bare floor, those that point down, except the flattest.
  const bool bare = std::all_of(world.model->geom_type, world.model->geom_type + world.model->ngeom,
                                [](int type) { return type == mjGEOM_PLANE; });
  EXPECT_GE(flat + curved, (bare ? 0.45 : 0.5) * kOrigins * kRays) << name;
  testing::Test::RecordProperty(name, std::to_string(flat) + " flat, " + std::to_string(flat - flat_exact) +
                                          " at edges, " + std::to_string(curved) + " curved");
}

TEST(RaySceneOracle, AgreesWithMuJoCoInEveryRoom) {
  int rooms = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MERLIN_SOURCE_DIR "/models/rooms")) {
    if (entry.path().extension() != ".xml") continue;
    const Mujoco world(ParseFile(entry.path()));
    ASSERT_NE(world.model, nullptr) << entry.path();
    ExpectAgreement(world, RayScene(world.model, world.SkipNothing()), entry.path().stem().string());
    ++rooms;
  }
  EXPECT_GE(rooms, 3);
}

TEST(RaySceneOracle, AgreesWithMuJoCoForEveryShape) {
  const Mujoco world(Parse(kShapes));
  ExpectAgreement(world, RayScene(world.model, world.SkipNothing()), "shapes");
}

TEST(RaySceneOracle, AgreesWithMuJoCoAfterBodiesHaveMoved) {
  const Mujoco world(Parse(kShapes));
  RayScene scene(world.model, world.SkipNothing());
  const Eigen::Vector3d cart(2, -2, 2);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()));
  std::copy_n(cart.data(), 3, world.data->mocap_pos);
  const double quaternion[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy_n(quaternion, 4, world.data->mocap_quat);
  world.data->qpos[0] = 2.5;
  mj_forward(world.model, world.data);
  scene.Update(MotionsOf(world.model, world.data));
  ExpectAgreement(world, scene, "moved");
}

TEST(RayScene, KeepsTheSnapshotWhileTheWorldMovesOn) {
  const Mujoco world(Parse(kShapes));
  RayScene scene(world.model, world.SkipNothing());
  const BodyMotions before = MotionsOf(world.model, world.data);
  world.data->mocap_pos[0] = 20.0;
  mj_forward(world.model, world.data);
  scene.Update(before);
  EXPECT_NEAR(CastOne(scene, {7, 0, 5}, {0, 0, -1}).range_m, 5 - 1 - 0.6 * std::cos(0.2) * std::cos(0.1) - 0.3, 0.05);
  scene.Update(MotionsOf(world.model, world.data));
  EXPECT_EQ(CastOne(scene, {7, 0, 5}, {0, 0, -1}).geom, world.Geom("floor"));
}

constexpr char kVisibility[] = R"(
<mujoco>
  <asset>
    <material name="clear" rgba="1 1 1 0"/>
    <material name="solid" rgba="1 1 1 1"/>
  </asset>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 1"/>
    <geom name="clear" type="box" size=".1 .1 .1" pos="1 0 1" rgba="1 0 0 0"/>
    <geom name="clear_material" type="sphere" size=".1" pos="2 0 1" material="clear"/>
    <geom name="solid_material" type="box" size=".1 .1 .1" pos="3 0 1" material="solid"/>
    <geom name="faint" type="box" size=".1 .1 .1" pos="4 0 1" rgba="1 0 0 .01"/>
    <geom name="group2" type="box" size=".1 .1 .1" pos="5 0 1" group="2"/>
    <geom name="group3" type="box" size=".1 .1 .1" pos="6 0 1" group="3"/>
    <body name="car" pos="7 0 1"><freejoint/><geom name="car" type="box" size=".1 .1 .1"/></body>
  </worldbody>
</mujoco>)";

TEST(RayScene, SeesWhatIsVisibleAndNotSkipped) {
  const Mujoco world(Parse(kVisibility));
  std::vector<bool> skip = world.SkipNothing();
  skip[static_cast<std::size_t>(world.Body("car"))] = true;
  const RayScene scene(world.model, skip);
  const auto below = [&](double x) {
    const int geom = CastOne(scene, {x, 0, 3}, {0, 0, -1}).geom;
    return std::string(geom < 0 ? "nothing" : mj_id2name(world.model, mjOBJ_GEOM, geom));
  };
  EXPECT_EQ(below(1), "floor");
  EXPECT_EQ(below(2), "floor");
  EXPECT_EQ(below(3), "solid_material");
  EXPECT_EQ(below(4), "faint");
  EXPECT_EQ(below(5), "group2");
  EXPECT_EQ(below(6), "floor");
  EXPECT_EQ(below(7), "floor");
}

TEST(RayScene, GivesNothingBeyondItsReachAndPlanesFromAboveOnly) {
  const Mujoco world(Parse(kVisibility));
  const RayScene scene(world.model, world.SkipNothing());
  EXPECT_NEAR(CastOne(scene, {0, 0, 3}, {0, 0, -1}, 3.01f).range_m, 3.0f, 1e-6f);
  EXPECT_EQ(CastOne(scene, {0, 0, 3}, {0, 0, -1}, 2.99f).geom, -1);
  EXPECT_LT(CastOne(scene, {0, 0, 3}, {0, 0, -1}, 2.99f).range_m, 0.0f);
  EXPECT_EQ(CastOne(scene, {0, 0, 3}, {0, 0, 1}).geom, -1);
  EXPECT_EQ(CastOne(scene, {0, 0, -3}, {0, 0, 1}).geom, -1);
  EXPECT_EQ(CastOne(scene, {0, 0, 3}, {1, 0, 0}).geom, -1);
  const RayHit hit = CastOne(scene, {0, 0, 1}, Eigen::Vector3f(1, 0, -1).normalized());
  EXPECT_NEAR(hit.range_m, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR((hit.normal - Eigen::Vector3f::UnitZ()).norm(), 0.0f, 1e-6f);
}

TEST(RayScene, TurnsNormalsTowardsTheOriginFromInsideToo) {
  const Mujoco world(Parse(kShapes));
  const RayScene scene(world.model, world.SkipNothing());
  const RayHit hit = CastOne(scene, {3, 1, 1}, {0, 0, 1});  // the middle of the sphere
  EXPECT_EQ(hit.geom, world.Geom("sphere"));
  EXPECT_NEAR(hit.range_m, 0.7f, 1e-6f);
  EXPECT_NEAR((hit.normal + Eigen::Vector3f::UnitZ()).norm(), 0.0f, 1e-6f);
}

TEST(RayScene, GivesARayTheSameBitsInAnyCompany) {
  const Mujoco world(Parse(kShapes));
  const RayScene scene(world.model, world.SkipNothing());
  Random random(1, Sensor::kDepth, 0);
  std::vector<Ray> rays;
  for (int i = 0; i < 1003; ++i) {  // not a multiple of a packet
    rays.push_back(
        {{0, 0, 1}, Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()).normalized().cast<float>()});
  }
  std::vector<RayHit> hits(rays.size());
  scene.Cast(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit alone = CastOne(scene, {0, 0, 1}, rays[i].direction);
    ASSERT_EQ(alone.range_m, hits[i].range_m) << i;
    ASSERT_EQ(alone.geom, hits[i].geom) << i;
  }
}

TEST(RayScene, LivesInAnEmptyWorld) {
  const Mujoco world(Parse("<mujoco/>"));
  const RayScene scene(world.model, world.SkipNothing());
  EXPECT_EQ(CastOne(scene, {0, 0, 1}, {1, 0, 0}).geom, -1);
  scene.Cast({}, {});
}

TEST(RayScene, RefusesAGeomItCannotSee) {
  const Mujoco world(
      Parse(R"(<mujoco><asset><hfield name="hill" nrow="2" ncol="2" size="1 1 1 1" elevation="0 0 0 1"/></asset>
    <worldbody><geom name="hill" type="hfield" hfield="hill"/></worldbody></mujoco>)"));
  EXPECT_THROW(RayScene(world.model, world.SkipNothing()), InputError);
}

}  // namespace
}  // namespace merlin::sim
