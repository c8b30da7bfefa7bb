// Cars that others described drive and see in the twin like ours.
#include <gtest/gtest.h>

#include <functional>

#include "tests/robot/description/foreign_cars.h"
#include "tests/sim/world/car_world.h"

namespace merlin::sim {
namespace {

struct Foreign {
  const char* name;
  void (*write)(const ForeignCar&);
};

class AnyCar : public testing::TestWithParam<Foreign> {
 protected:
  AnyCar() {
    GetParam().write(files_);
    car_ = ReadCar(files_.urdf());
  }
  std::unique_ptr<World> Place(const std::string& worldbody, const Pose& T_world_start = Pose::Identity()) const {
    const TemporaryFile room("room.xml", Room(worldbody));
    // The electronics are tested elsewhere.
    return std::make_unique<World>(WorldOptions{
        .room = room.path(), .car = car_, .T_world_start = T_world_start, .drivetrain = IdealDrivetrain()});
  }
  double Angle_rad(const World& world, std::size_t link) const {
    const int joint = mj_name2id(world.model(), mjOBJ_JOINT, car_.links[link].joint_name.c_str());
    return world.data()->qpos[world.model()->jnt_qposadr[joint]];
  }

  ForeignCar files_;
  CarDescription car_;
};

TEST_P(AnyCar, DrivesTheCircleOfAckermann) {
  for (const double degrees : {-18.0, 8.0, 18.0}) {
    const double steering_rad = degrees * std::numbers::pi / 180.0;
    const auto world = Place(kPlane);
    Send(*world, 0.3, steering_rad);
    StepFor(*world, 1.5);
    double path_m = 0.0, turn_rad = 0.0;
    while (world->Now() < FromSeconds(6.0)) {
      const Pose before = world->T_world_base();
      world->Step();
      path_m += (world->T_world_base().translation() - before.translation()).norm();
      turn_rad += WrapPi(Yaw(world->T_world_base()) - Yaw(before));
    }
    const double expected_m = car_.wheelbase_m / std::tan(steering_rad);
    EXPECT_NEAR(path_m / turn_rad, expected_m, 0.005 * std::abs(expected_m)) << degrees;
    EXPECT_NEAR(world->Speed_m_s(), 0.3, 0.01) << degrees;
    // The front wheels aim at the centre of that circle, seen from their steering axes.
    EXPECT_NEAR(Angle_rad(*world, car_.knuckles[0]),
                std::atan2(car_.wheelbase_m, expected_m - car_.steering_track_m / 2) -
                    (steering_rad < 0 ? std::numbers::pi : 0.0),
                0.2 * std::numbers::pi / 180.0)
        << degrees;
    EXPECT_NEAR(Angle_rad(*world, car_.knuckles[1]),
                std::atan2(car_.wheelbase_m, expected_m + car_.steering_track_m / 2) -
                    (steering_rad < 0 ? std::numbers::pi : 0.0),
                0.2 * std::numbers::pi / 180.0)
        << degrees;
  }
}

TEST_P(AnyCar, DrivesAheadAndCountsForwards) {
  const auto world = Place(kPlane, FromXyYaw(1.0, 2.0, 0.5));
  EXPECT_NEAR(world->T_world_base().translation().z(), 0.0, 1e-3);
  Send(*world, 0.5, 0.0);
  StepFor(*world, 3.0);
  const Eigen::Vector3d way = FromXyYaw(1.0, 2.0, 0.5).inverse() * world->T_world_base().translation();
  EXPECT_GT(way.x(), 1.2);
  EXPECT_NEAR(way.y(), 0.0, 0.002);
  EXPECT_NEAR(static_cast<double>(Read(*world).encoder_counts) * car_.MetresPerCount(), way.x(), 0.01);
  EXPECT_TRUE(world->CarTouches().empty());
}

TEST_P(AnyCar, StandsStill) {
  const auto world = Place(kPlane);
  StepFor(*world, 1.0);
  const Pose before = world->T_world_base();
  StepFor(*world, 5.0);
  EXPECT_LT((world->T_world_base().translation() - before.translation()).norm(), 1e-6);
}

// With a wall across the path, each camera must measure the distance that its position and direction imply.
TEST_P(AnyCar, SeesWithItsCamerasAtTheirPlaces) {
  const Pose T_world_start = FromXyYaw(-1.0, 0.3, 0.0);
  const auto world =
      Place(std::string(kPlane) + R"(<geom name="wall" type="box" pos="2.1 0 1" size="0.1 4 1"/>)", T_world_start);
  constexpr mjtByte kSeenGroups[mjNGROUP] = {1, 0, 0, 0, 0, 0};  // the room's, not the car's own
  for (const Pose& T_base_camera : {car_.T_base_depth, car_.T_base_color.value()}) {
    const Pose T_world_camera = world->T_world_base() * T_base_camera;
    const Eigen::Vector3d eye = T_world_camera.translation(), ahead = T_world_camera.linear().col(2);
    int geom = -1;
    const double range_m =
        mj_ray(world->model(), world->data(), eye.data(), ahead.data(), kSeenGroups, 1, -1, &geom, nullptr);
    EXPECT_EQ(std::string(mj_id2name(world->model(), mjOBJ_GEOM, geom)), "wall");
    EXPECT_NEAR(range_m * ahead.x(), 2.0 - eye.x(), 1e-3);
    EXPECT_GT(ahead.x(), 0.99);
  }
  for (const CarLink& link : car_.links)
    EXPECT_GE(mj_name2id(world->model(), mjOBJ_BODY, link.name.c_str()), 0) << link.name;
}

// If MuJoCo rejects the car, the message blames the car and not the room.
TEST_P(AnyCar, IsBlamedForWhatDoesNotCompile) {
  for (CarLink& link : car_.links) link.mass_kg = 0.0;
  try {
    Place(kPlane);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(car_.file.string() + ": the car does not compile"))
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Foreign, AnyCar, testing::Values(Foreign{"rover", WriteRover}, Foreign{"buggy", WriteBuggy}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace merlin::sim
