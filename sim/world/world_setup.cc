// Builds a world: joins the room, the car and the actors in one model and rejects bad input.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>
#include <stdexcept>

#include "robot/base/error.h"
#include "sim/actors/actor_body.h"
#include "sim/drive/drivetrain.h"
#include "sim/world/car_body.h"
#include "sim/world/room.h"
#include "sim/world/room_box.h"
#include "sim/world/shape.h"
#include "sim/world/solid.h"
#include "sim/world/spec.h"
#include "sim/world/surface.h"
#include "sim/world/true_car.h"
#include "sim/world/world.h"

namespace merlin::sim {
namespace {

constexpr double kFarthest_m = 1e5;     // limit for the position of any geom
constexpr double kFloorSearch_m = 0.5;  // range above and below the start in which the floor is searched

// The physics options that the car was tuned with.
void SetOptions(mjSpec* spec) {
  spec->option.timestep = Seconds(World::kStep);
  spec->option.integrator = mjINT_IMPLICITFAST;
  spec->option.cone = mjCONE_ELLIPTIC;
  spec->option.impratio = 10.0;
  spec->option.solver = mjSOL_NEWTON;
  spec->option.disableflags |= mjDSBL_AUTORESET;  // otherwise a bad number would silently restart the simulation
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

// The error for a room that does not compile with the car in it. If it compiles without the car, the car is at fault.
InputError CompileError(const WorldOptions& options, const std::string& mujoco_message) {
  const SpecPtr room = ReadRoom(options.room, options.curtain_closed);
  SetOptions(room.get());
  const std::unique_ptr<mjModel, void (*)(mjModel*)> alone(mj_compile(room.get(), nullptr), mj_deleteModel);
  const bool car = alone && !options.car.file.empty();
  if (car) return RoomError(options.car.file, "the car does not compile", mujoco_message);
  return RoomError(options.room, "the room with the car in it does not compile", mujoco_message);
}

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
  Actors::AddTo(spec.get(), options.actors, options.obstacles);
  model_.reset(mj_compile(spec.get(), nullptr));
  if (!model_) throw CompileError(options, mjs_getError(spec.get()));
  data_.reset(mj_makeData(model_.get()));
  if (!data_) throw std::runtime_error("MuJoCo cannot make its data: out of memory");
  ReadNumerics(options.room.string());
  NameParts(options.car);
  for (const mjsGeom* ground : solid.grounds) is_floor_[mjs_getId(ground->element)] = true;
  const auto tyre = std::ranges::find_if(std::views::iota(0, static_cast<int>(model_->ngeom)), [this](int geom) {
    return is_wheel_[geom] && model_->geom_contype[geom] != 0;
  });
  SetGrip(model_.get(), is_floor_, *tyre, options.materials, drivetrain.surface);
  PutOnFloor(options);
  actors_ = Actors(model_.get(), options.actors, options.obstacles, is_car_);
  actors_.Move(data_.get(), Now(), T_world_base());
  mj_forward(model_.get(), data_.get());
  actors_.UpdateWaiting(model_.get(), data_.get());
  RefuseGeomsNowhere(options.room.string());
  RefusePathsOutOfTheRoom(options.actors);
  RefuseStartInContact(options);
  drive_ = DriveController(model_.get(), options.car, drivetrain, options.seed);
  if (pans) pan_ = PanServo(model_.get(), options.car);
  if (options.turntable_rate_rad_s) turntable_ = Turntable(options.car, T_world_base(), *options.turntable_rate_rad_s);
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

void World::NameParts(const CarDescription& car) {
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

void World::RefuseGeomsNowhere(const std::string& room) const {
  for (int geom = 0; geom < model_->ngeom; ++geom)
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(data_->geom_xpos[3 * geom + axis]) < kFarthest_m))
        throw InputError(room, "geom '" + GeomName(model_.get(), geom) + "' has an impossible position",
                         fmt::format("a position within {:g} m", kFarthest_m),
                         fmt::format("{:g}", data_->geom_xpos[3 * geom + axis]));
}

void World::RefusePathsOutOfTheRoom(const std::vector<ActorConfig>& actors) const {
  const std::vector<Eigen::Vector2d> outline_m = RoomOutline_m(*this);
  if (outline_m.empty()) return;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : outline_m) box.extend(corner);
  std::string all;
  for (const ActorConfig& actor : actors) {
    const std::vector<Eigen::Vector3d> points = TimedPath(actor.path).positions_m();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d from = points[i == 0 ? 0 : i - 1], to = points[i];
      if (HoldsLine(outline_m, from.head<2>(), to.head<2>())) continue;
      const int body = mj_name2id(model_.get(), mjOBJ_BODY, BodyName(actor).c_str());
      const InputError fault(actors_.Describe(body), "its path leaves the room",
                             fmt::format("all of it within the outline (x {:g} to {:g} m, y {:g} to {:g} m)",
                                         box.min().x(), box.max().x(), box.min().y(), box.max().y()),
                             fmt::format("path[{}] at x {:g} m, y {:g} m", i, to.x(), to.y()));
      all += (all.empty() ? "" : "\n") + std::string(fault.what());
      break;
    }
  }
  if (!all.empty()) throw InputError(all);
}

void World::RefuseStartInContact(const WorldOptions& options) const {
  const Eigen::Vector3d start = options.T_world_start.translation();
  const auto refuse = [&](const std::string& part, const std::string& other) {
    const int geom = mj_name2id(model_.get(), mjOBJ_GEOM, other.c_str());
    const std::string actor = geom < 0 ? "" : actors_.Describe(model_->geom_bodyid[geom]);
    if (!actor.empty())
      throw InputError(actor, "it is present at the start and touches the car", "a free place, or a later time",
                       "the car's " + part + fmt::format(" in it at x {:g} m, y {:g} m", start.x(), start.y()));
    std::string notes;  // possible reasons
    for (const std::string& warning : warnings_) notes += "; " + warning;
    if (geom >= 0 && model_->geom_type[geom] == mjGEOM_MESH)
      notes +=
          "; a closed mesh is solid inside: a hollow one to drive in needs an open side or faces that point inward";
    throw InputError(options.room.string(), fmt::format("the car cannot start at x {} m, y {} m", start.x(), start.y()),
                     "a free place", fmt::format("its {} in '{}'{}", part, other, notes));
  };
  if (const auto touches = CarTouches(); !touches.empty()) refuse(touches[0].car_geom, touches[0].other_geom);
  // A part that lies entirely inside a solid has no contact with its surface, so this is checked separately.
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

}  // namespace merlin::sim
