#include "sim/world/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>
#include <stdexcept>

#include "robot/base/error.h"
#include "sim/drive/drivetrain.h"
#include "sim/world/car_body.h"
#include "sim/world/room.h"
#include "sim/world/shape.h"
#include "sim/world/solid.h"
#include "sim/world/spec.h"
#include "sim/world/surface.h"
#include "sim/world/true_car.h"

namespace merlin::sim {
namespace {

constexpr double kParkingHeight_m = -50.0;  // of obstacles that are away
constexpr double kFarthest_m = 1e5;         // of any geom from the origin
constexpr double kFloorSearch_m = 0.5;      // above and below the start's height

// The physics that the car was tuned with.
void SetOptions(mjSpec* spec) {
  spec->option.timestep = Seconds(World::kStep);
  spec->option.integrator = mjINT_IMPLICITFAST;
  spec->option.cone = mjCONE_ELLIPTIC;
  spec->option.impratio = 10.0;
  spec->option.solver = mjSOL_NEWTON;
  spec->option.disableflags |= mjDSBL_AUTORESET;  // else a bad number restarts the simulation silently
}

void RefuseFaults(const DrivetrainConfig& config) {
  const std::vector<Fault> faults = Validate(config);
  if (faults.empty()) return;
  std::string all;
  for (const Fault& fault : faults)
    all += fmt::format("{}drivetrain.{}: expected a number {}, got {}", all.empty() ? "" : "\n", fault.field,
                       fault.rule, fault.value);
  throw InputError(all);
}

// The error of a room that does not compile with the car in it: the car's, where the room does without.
InputError CompileError(const WorldOptions& options, const std::string& mujoco_message) {
  const SpecPtr room = ReadRoom(options.room, options.curtain_closed);
  SetOptions(room.get());
  const std::unique_ptr<mjModel, void (*)(mjModel*)> alone(mj_compile(room.get(), nullptr), mj_deleteModel);
  const bool car = alone && !options.car.file.empty();
  if (car) return RoomError(options.car.file, "the car does not compile", mujoco_message);
  return RoomError(options.room, "the room with the car in it does not compile", mujoco_message);
}

std::string ObstacleName(const std::string& name) { return "obstacle_" + name; }

}  // namespace

World::World(const WorldOptions& options) {
  RefuseFaults(options.drivetrain);
  const DrivetrainConfig drivetrain = options.drivetrain.ideal ? IdealDrivetrain() : options.drivetrain;
  const CarDescription true_car = TrueCar(options.car, drivetrain);
  SpecPtr spec = ReadRoom(options.room, options.curtain_closed);
  const ModelPtr alone = CompileAlone(options.room, options.curtain_closed);
  KeepFromCar(spec.get(), alone.get());
  const SolidRoom solid = MakeSolid(spec.get(), alone.get(), options.materials, options.room);
  warnings_ = solid.warnings;
  SetOptions(spec.get());
  car_body::AddTo(spec.get(), true_car, options.T_world_start);
  drivetrain::AddTo(spec.get(), true_car);
  const bool pans = true_car.pan && true_car.pan->moves;
  if (pans) PanServo::AddTo(spec.get(), true_car);
  AddObstacles(spec.get(), options.obstacles);
  model_.reset(mj_compile(spec.get(), nullptr));
  if (!model_) throw CompileError(options, mjs_getError(spec.get()));
  data_.reset(mj_makeData(model_.get()));
  if (!data_) throw std::runtime_error("MuJoCo cannot make its data: out of memory");
  ReadNumerics(options.room.string());
  NameParts(options.car, options.obstacles);
  for (const mjsGeom* ground : solid.grounds) is_floor_[mjs_getId(ground->element)] = true;
  const auto tyre = std::ranges::find_if(std::views::iota(0, static_cast<int>(model_->ngeom)), [this](int geom) {
    return is_wheel_[geom] && model_->geom_contype[geom] != 0;
  });
  SetGrip(model_.get(), is_floor_, *tyre, options.materials, drivetrain.surface);
  PutOnFloor(options);
  mj_forward(model_.get(), data_.get());
  for (int geom = 0; geom < model_->ngeom; ++geom)
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(data_->geom_xpos[3 * geom + axis]) < kFarthest_m))
        throw InputError(options.room.string(), "geom '" + GeomName(model_.get(), geom) + "' stands nowhere",
                         fmt::format("a position within {:g} m", kFarthest_m),
                         fmt::format("{:g}", data_->geom_xpos[3 * geom + axis]));
  RefuseStartInContact(options);
  drive_ = DriveController(model_.get(), options.car, drivetrain, options.seed);
  if (pans) pan_ = PanServo(model_.get(), options.car);
  if (options.turntable_rate_rad_s) turntable_ = Turntable(options.car, T_world_base(), *options.turntable_rate_rad_s);
}

World::~World() = default;

void World::AddObstacles(mjSpec* spec, const std::vector<Obstacle>& obstacles) const {
  const BuiltinDefaults plain;
  for (const Obstacle& obstacle : obstacles) {
    if (!(obstacle.size_m.array() > 0.0).all() || !obstacle.size_m.allFinite())
      throw InputError("obstacle '" + obstacle.name + "'", "size", "three positive lengths");
    mjsBody* body = mjs_addBody(mjs_findBody(spec, "world"), plain.get());
    SetName(body->element, ObstacleName(obstacle.name));
    body->mocap = 1;
    body->pos[2] = kParkingHeight_m;
    mjsGeom* geom = mjs_addGeom(body, plain.get());
    SetName(geom->element, ObstacleName(obstacle.name));
    geom->type = mjGEOM_BOX;
    geom->contype |= kMeetsCar;
    Eigen::Vector3d::Map(geom->size) = obstacle.size_m / 2.0;
    geom->pos[2] = obstacle.size_m.z() / 2.0;
    if (obstacle.material.empty()) continue;
    if (mjs_findElement(spec, mjOBJ_MATERIAL, obstacle.material.c_str()) == nullptr)
      SetName(mjs_addMaterial(spec, plain.get())->element, obstacle.material);
    mjs_setString(geom->material, obstacle.material.c_str());
  }
}

void World::ReadNumerics(const std::string& room) {
  const auto numbers = [this](const char* name) -> std::span<const mjtNum> {
    const int id = mj_name2id(model_.get(), mjOBJ_NUMERIC, name);
    if (id < 0) return {};
    return {model_->numeric_data + model_->numeric_adr[id], static_cast<std::size_t>(model_->numeric_size[id])};
  };
  const auto plan = numbers("plan_xy_m");
  if (plan.size() % 2 != 0 || (!plan.empty() && plan.size() < 6))
    throw InputError(room, "numeric plan_xy_m", "x and y of three corners or more",
                     fmt::format("{} numbers", plan.size()));
  for (const mjtNum number : plan)
    if (!std::isfinite(number))
      throw InputError(room, "numeric plan_xy_m", "finite numbers", fmt::format("{}", number));
  for (std::size_t i = 0; i < plan.size(); i += 2) plan_xy_m_.emplace_back(plan[i], plan[i + 1]);
  if (const auto north = numbers("north_yaw_rad"); !north.empty()) north_yaw_rad_ = north[0];
}

void World::NameParts(const CarDescription& car, const std::vector<Obstacle>& obstacles) {
  const auto body_id = [this](const std::string& name) { return mj_name2id(model_.get(), mjOBJ_BODY, name.c_str()); };
  car_ = car;
  base_body_ = body_id(car.links[0].name);
  if (car.pan && car.pan->moves) pan_body_ = body_id(car.links[car.pan->link].name);
  wheel_radius_m_ = car.wheel_radius_m;
  std::vector<bool> wheel_bodies(model_->nbody, false);
  for (const CarWheel& wheel : car.wheels) wheel_bodies[body_id(car.links[wheel.link].name)] = true;
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const int body = model_->geom_bodyid[geom];
    is_car_.push_back(model_->body_rootid[body] == base_body_);
    is_wheel_.push_back(wheel_bodies[body]);
    is_floor_.push_back(!is_car_.back() && IsFloor(model_.get(), geom));
  }
  for (const Obstacle& obstacle : obstacles) obstacle_bodies_[obstacle.name] = body_id(ObstacleName(obstacle.name));
}

void World::PutOnFloor(const WorldOptions& options) {
  const std::string room = options.room.string();
  if (std::find(is_floor_.begin(), is_floor_.end(), true) == is_floor_.end())
    throw InputError(room, "the room has no floor", "a geom named floor*");
  mj_kinematics(model_.get(), data_.get());
  const Eigen::Vector3d start = options.T_world_start.translation();
  const mjtNum from[3] = {start.x(), start.y(), start.z() + kFloorSearch_m}, down[3] = {0.0, 0.0, -1.0};
  double nearest_m = 2.0 * kFloorSearch_m;
  bool found = false;
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    if (!is_floor_[geom]) continue;
    const mjtNum *pos = data_->geom_xpos + 3 * geom, *mat = data_->geom_xmat + 9 * geom;
    mjtNum range_m = -1.0;
    if (model_->geom_type[geom] == mjGEOM_MESH)
      range_m = mj_rayMesh(model_.get(), data_.get(), geom, from, down, nullptr);
    else if (model_->geom_type[geom] == mjGEOM_HFIELD)
      range_m = mj_rayHfield(model_.get(), data_.get(), geom, from, down, nullptr);
    else
      range_m = mju_rayGeom(pos, mat, model_->geom_size + 3 * geom, from, down, model_->geom_type[geom], nullptr);
    if (range_m < 0.0 || range_m > nearest_m) continue;
    nearest_m = range_m;
    found = true;
  }
  if (!found)
    throw InputError(room, "the car does not start on the floor", "a geom named floor* below the start",
                     fmt::format("nothing at x {} m, y {} m", start.x(), start.y()));
  const double lift_m = options.turntable_rate_rad_s ? kTurntableHeight_m : 0.0;
  data_->qpos[model_->jnt_qposadr[model_->body_jntadr[base_body_]] + 2] =
      start.z() + kFloorSearch_m - nearest_m + lift_m;
}

void World::RefuseStartInContact(const WorldOptions& options) const {
  const Eigen::Vector3d start = options.T_world_start.translation();
  const auto refuse = [&](const std::string& part, const std::string& other) {
    std::string notes;  // what may be the reason
    for (const std::string& warning : warnings_) notes += "; " + warning;
    const int geom = mj_name2id(model_.get(), mjOBJ_GEOM, other.c_str());
    if (geom >= 0 && model_->geom_type[geom] == mjGEOM_MESH)
      notes += "; a closed mesh is solid within, a shell to drive in has an open side or faces that look inward";
    throw InputError(options.room.string(), fmt::format("the car cannot start at x {} m, y {} m", start.x(), start.y()),
                     "a free place", fmt::format("its {} in '{}'{}", part, other, notes));
  };
  if (const auto touches = CarTouches(); !touches.empty()) refuse(touches[0].car_geom, touches[0].other_geom);
  // A part wholly inside a solid has no contact with its surface.
  for (int part = 0; part < model_->ngeom; ++part) {
    if (!is_car_[part] || model_->geom_contype[part] == 0) continue;
    for (int other = 0; other < model_->ngeom; ++other) {
      const bool meets = (model_->geom_contype[part] & model_->geom_conaffinity[other]) != 0 ||
                         (model_->geom_contype[other] & model_->geom_conaffinity[part]) != 0;
      if (meets && !is_car_[other] && IsInside(model_.get(), data_.get(), other, data_->geom_xpos + 3 * part))
        refuse(GeomName(model_.get(), part), SeenName(model_.get(), other));
    }
  }
}

void World::Step() {
  drive_.Apply(model_.get(), data_.get(), Now());
  if (pan_) pan_->Apply(data_.get());
  // mj_step in two halves, the first of the next step already taken: what depends on position and velocity stays
  // current.
  mj_step2(model_.get(), data_.get());
  if (turntable_) FollowTurntable();
  mj_step1(model_.get(), data_.get());
  for (int i = 0; i < mjNWARNING; ++i)
    if (data_->warning[i].number > 0)
      throw std::runtime_error(
          fmt::format("MuJoCo stopped at {:.3f} s: {}", data_->time, mju_warningText(i, data_->warning[i].lastinfo)));
  drive_.Follow(model_.get(), data_.get());  // only a sound state has counts
}

// The car is where the turntable has it.
void World::FollowTurntable() {
  turntable_->Step(kStep);
  const Pose T_world_base = turntable_->T_world_base();
  const Eigen::Quaterniond q(T_world_base.linear());
  const Eigen::Vector3d axle =
      T_world_base.linear() * car_.T_base_turntable().translation();  // from the base to the axis
  const Eigen::Vector3d turn(0.0, 0.0, turntable_->speed_rad_s());
  const int joint = model_->body_jntadr[base_body_];
  mjtNum *position = data_->qpos + model_->jnt_qposadr[joint], *velocity = data_->qvel + model_->jnt_dofadr[joint];
  Eigen::Vector3d::Map(position) = T_world_base.translation();
  Eigen::Vector4d::Map(position + 3) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  Eigen::Vector3d::Map(velocity) = turn.cross(-axle);
  Eigen::Vector3d::Map(velocity + 3) = turn;  // in the body's axes; its z is the world's
}

Time World::Now() const { return std::llround(data_->time / Seconds(kStep)) * kStep; }

Pose World::T_world_base() const {
  const mjtNum* q = data_->qpos + model_->jnt_qposadr[model_->body_jntadr[base_body_]];
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(q[0], q[1], q[2]);
  pose.linear() = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized().toRotationMatrix();
  return pose;
}

BodyMotion World::BaseMotion() const {
  mjtNum velocity[6];  // angular, linear
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, base_body_, velocity, 0);
  return {T_world_base(), {velocity[3], velocity[4], velocity[5]}, {velocity[0], velocity[1], velocity[2]}};
}

BodyMotion World::CameraMotion(const Pose& T_base_camera) const {
  if (!pan_) return BaseMotion().Of(T_base_camera);
  const BodyMotion base = BaseMotion();
  BodyMotion camera = base.Of(car_.pan->Turned(T_base_camera, pan_->Read_rad(data_.get())));
  mjtNum velocity[6];  // angular, linear
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, pan_body_, velocity, 0);
  const Eigen::Vector3d turn(velocity[0], velocity[1], velocity[2]);
  const Eigen::Vector3d pivot = base.T_world_body * car_.pan->T_base_pan.translation();
  camera.velocity_m_s =
      Eigen::Vector3d(velocity[3], velocity[4], velocity[5]) + turn.cross(camera.T_world_body.translation() - pivot);
  camera.angular_velocity_rad_s = turn;
  return camera;
}

double World::Speed_m_s() const {
  // A free joint's linear velocity is that of the body's origin in the world's axes, its angular velocity in the
  // body's.
  const mjtNum* v = data_->qvel + model_->jnt_dofadr[model_->body_jntadr[base_body_]];
  const Eigen::Vector3d forward_world = T_world_base().linear().col(0);
  return forward_world.dot(Eigen::Vector3d(v[0], v[1], v[2])) + v[4] * wheel_radius_m_;
}

std::vector<Touch> World::CarTouches() const {
  std::vector<Touch> touches;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    int car = contact.geom[0], other = contact.geom[1];
    if (car < 0 || other < 0 || contact.dist > 0.0) continue;  // flexes have no geom
    if (!is_car_[car]) std::swap(car, other);
    if (!is_car_[car] || is_car_[other] || (is_wheel_[car] && is_floor_[other])) continue;
    touches.push_back({GeomName(model_.get(), car), SeenName(model_.get(), other)});
  }
  return touches;
}

bool World::WheelTouchesGround() const {
  constexpr double kLevel = 0.7071;  // cosine of 45 degrees
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    int wheel = contact.geom[0], ground = contact.geom[1];
    if (wheel < 0 || ground < 0 || contact.dist > 0.0) continue;
    if (!is_wheel_[wheel]) std::swap(wheel, ground);
    if (!is_wheel_[wheel] || is_car_[ground]) continue;
    if (is_floor_[ground] || std::abs(contact.frame[2]) > kLevel) return true;
  }
  return false;
}

bool World::IsCarGeom(int geom_id) const { return is_car_.at(static_cast<std::size_t>(geom_id)); }

int World::ObstacleBody(const std::string& name) const {
  const auto body = obstacle_bodies_.find(name);
  if (body == obstacle_bodies_.end()) throw InputError("obstacle '" + name + "'", "no such obstacle in this world");
  return body->second;
}

void World::MoveObstacle(const std::string& name, const Pose& T_world_obstacle) {
  const int mocap = model_->body_mocapid[ObstacleBody(name)];
  const Eigen::Quaterniond q(T_world_obstacle.linear());
  Eigen::Vector3d::Map(data_->mocap_pos + 3 * mocap) = T_world_obstacle.translation();
  Eigen::Vector4d::Map(data_->mocap_quat + 4 * mocap) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  mj_step1(model_.get(), data_.get());
}

void World::PlaceObstacle(const std::string& name, const Pose& T_world_obstacle) {
  MoveObstacle(name, T_world_obstacle);
}

void World::RemoveObstacle(const std::string& name) {
  MoveObstacle(name, Pose(Eigen::Translation3d(0.0, 0.0, kParkingHeight_m)));
}

double World::ObstacleDistance_m(const std::string& name, double max_m) const {
  const int obstacle = model_->body_geomadr[ObstacleBody(name)];
  double nearest_m = max_m;
  for (int geom = 0; geom < model_->ngeom; ++geom)
    if (is_car_[geom] && model_->geom_contype[geom] != 0)
      nearest_m = std::min(nearest_m, mj_geomDistance(model_.get(), data_.get(), geom, obstacle, max_m, nullptr));
  return nearest_m;
}

std::vector<double> World::State() const {
  constexpr int kParts = mjSTATE_TIME | mjSTATE_QPOS | mjSTATE_QVEL | mjSTATE_ACT;
  std::vector<double> state(static_cast<std::size_t>(mj_stateSize(model_.get(), kParts)));
  mj_getState(model_.get(), data_.get(), state.data(), kParts);
  return state;
}

}  // namespace merlin::sim
