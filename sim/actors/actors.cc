#include "sim/actors/actors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/actors/actor_body.h"

namespace merlin::sim {
namespace {

const BodyMotion kAway{.T_world_body = Pose(Eigen::Translation3d(0.0, 0.0, kAwayHeight_m))};

std::string Prefix(const std::string& where) { return where.empty() ? "" : where + ": "; }

}  // namespace

void Actors::AddTo(mjSpec* spec, const std::vector<ActorConfig>& actors, const std::vector<ObstacleConfig>& obstacles) {
  RefuseFaults(actors);
  for (std::size_t i = 0; i < obstacles.size(); ++i) AddObstacleBody(spec, obstacles[i], i);
  for (const ActorConfig& actor : actors) AddActorBody(spec, actor);
}

Actors::Actors(const mjModel* model, const std::vector<ActorConfig>& actors,
               const std::vector<ObstacleConfig>& obstacles, const std::vector<bool>& is_car) {
  const auto add = [&](One one) {
    one.body = mj_name2id(model, mjOBJ_BODY, one.name.c_str());
    one.mocap = model->body_mocapid[one.body];
    one.motion = kAway;
    all_.push_back(std::move(one));
  };
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    add({.name = ObstacleBodyName(i),
         .description = fmt::format("{}obstacle {}", Prefix(obstacles[i].where), i),
         .obstacle = obstacles[i],
         .begin_s = obstacles[i].appear_s,
         .until_s = obstacles[i].disappear_s});
  for (const ActorConfig& actor : actors) {
    One one{.name = BodyName(actor),
            .description = fmt::format("{}actor '{}'", Prefix(actor.where), actor.name),
            .path = TimedPath(actor.path),
            .until_s = actor.until_s.value_or(HUGE_VAL),
            .wait_m = actor.wait_for_car_m};
    one.begin_s = one.path->begin_s();
    add(std::move(one));
  }
  for (int geom = 0; geom < model->ngeom; ++geom)
    if (is_car[static_cast<std::size_t>(geom)] && model->geom_contype[geom] != 0) car_geoms_.push_back(geom);
}

void Actors::Put(mjData* data, One& one, const BodyMotion& motion) const {
  const Eigen::Quaterniond q(motion.T_world_body.linear());
  Eigen::Vector3d::Map(data->mocap_pos + 3 * one.mocap) = motion.T_world_body.translation();
  Eigen::Vector4d::Map(data->mocap_quat + 4 * one.mocap) = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z());
  one.motion = motion;
}

void Actors::Move(mjData* data, Time now, const Pose& T_world_base) {
  const double now_s = Seconds(now), step_s = Seconds(now - last_);
  last_ = now;
  for (One& one : all_) {
    const bool was_present = one.present;
    one.present = now_s >= one.begin_s && now_s < one.until_s;
    if (was_present && one.waits) one.waited_s += step_s;
    if (one.present && one.path) {
      Put(data, one, one.path->At(now_s - one.waited_s));
    } else if (one.present && !was_present) {
      const Eigen::Vector3d p = T_world_base.translation();
      Put(data, one,
          {.T_world_body = FromXyYaw(p.x(), p.y(), Yaw(T_world_base)) *
                           FromXyYaw(one.obstacle.ahead_m + 0.5 * one.obstacle.length_m, one.obstacle.left_m, 0.0)});
    } else if (!one.present && was_present) {
      Put(data, one, kAway);
    }
  }
}

void Actors::UpdateWaiting(const mjModel* model, const mjData* data) {
  for (One& one : all_) {
    if (!one.present || !one.path || one.wait_m <= 0.0) continue;
    const double along_s = Seconds(last_) - one.waited_s;
    const BodyMotion going = one.path->At(along_s);
    const Nearest car = NearestToCar(model, data, one, one.wait_m);
    one.waits = car.distance_m < one.wait_m && car.toward_car.dot(going.velocity_m_s) > 0.0;
    one.motion = going;
    if (one.waits) one.motion.velocity_m_s = one.motion.angular_velocity_rad_s = Eigen::Vector3d::Zero();
  }
}

void Actors::AddVelocities(BodyMotions& bodies) const {
  for (const One& one : all_) {
    BodyMotion& body = bodies[static_cast<std::size_t>(one.body)];
    body.velocity_m_s = one.motion.velocity_m_s;
    body.angular_velocity_rad_s = one.motion.angular_velocity_rad_s;
  }
}

void Actors::AddState(const mjData* data, std::vector<double>& state) const {
  for (const One& one : all_) {
    if (!one.path) continue;
    state.insert(state.end(), data->mocap_pos + 3 * one.mocap, data->mocap_pos + 3 * one.mocap + 3);
    state.insert(state.end(), data->mocap_quat + 4 * one.mocap, data->mocap_quat + 4 * one.mocap + 4);
    for (const Eigen::Vector3d& velocity : {one.motion.velocity_m_s, one.motion.angular_velocity_rad_s})
      state.insert(state.end(), velocity.begin(), velocity.end());
  }
}

std::string Actors::Describe(int body) const {
  const auto found = std::ranges::find(all_, body, &One::body);
  return found == all_.end() ? "" : found->description;
}

double Actors::CarDistance_m(const mjModel* model, const mjData* data, std::size_t i, double max_m) const {
  return NearestToCar(model, data, all_[i], max_m).distance_m;
}

Actors::Nearest Actors::NearestToCar(const mjModel* model, const mjData* data, const One& one, double max_m) const {
  Nearest nearest{.distance_m = max_m};
  const int first = model->body_geomadr[one.body];
  for (int geom = first; geom < first + model->body_geomnum[one.body]; ++geom) {
    if (model->geom_contype[geom] == 0 && model->geom_conaffinity[geom] == 0) continue;
    for (const int car : car_geoms_) {
      // Bounding spheres first: most pairs are far apart, and an exact distance takes microseconds.
      const double apart_m = mju_dist3(data->geom_xpos + 3 * geom, data->geom_xpos + 3 * car);
      if (apart_m - model->geom_rbound[geom] - model->geom_rbound[car] >= nearest.distance_m) continue;
      mjtNum from_to[6];
      // MuJoCo needs a writable mjData for its scratch stack; the state does not change.
      const double distance_m =
          mj_geomDistance(model, const_cast<mjData*>(data), car, geom, nearest.distance_m, from_to);
      if (distance_m >= nearest.distance_m) continue;
      nearest.distance_m = distance_m;
      const Eigen::Vector3d on_car = Eigen::Vector3d::Map(from_to), on_actor = Eigen::Vector3d::Map(from_to + 3);
      nearest.toward_car = distance_m > 0.0 ? Eigen::Vector3d(on_car - on_actor) : Eigen::Vector3d(on_actor - on_car);
    }
  }
  return nearest;
}

}  // namespace merlin::sim
