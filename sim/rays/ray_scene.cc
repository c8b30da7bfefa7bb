#include "sim/rays/ray_scene.h"

#include <algorithm>
#include <cassert>
#include <deque>
#include <map>
#include <utility>

#include "robot/base/error.h"
#include "sim/rays/embree_group.h"

namespace merlin::sim {
namespace {

// One thread, because the scene is small and its bits must not depend on how it is built. The instruction set is fixed,
// so that all machines that have it get the same bits.
constexpr char kDeviceConfig[] = "threads=1,set_affinity=0,max_isa=avx2";

// A group that moves or has its own frame gets a scene of its own, and a pose.
struct Instance {
  const RayGroup* group;
  EmbreeScene scene;
  EmbreeGeometry geometry;
  Eigen::Matrix3f R_world_group = Eigen::Matrix3f::Identity();
  Eigen::Matrix4f T_world_group_last = Eigen::Matrix4f::Identity();
  bool placed = false;

  Instance(RTCDevice device, const RayGroup& of, unsigned number)
      : group(&of),
        scene(NewScene(device, RTC_SCENE_FLAG_ROBUST)),
        geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE)) {
    Attach(device, scene.get(), of, number);
    rtcCommitScene(scene.get());
    rtcSetGeometryInstancedScene(geometry.get(), scene.get());
    rtcSetGeometryMask(geometry.get(), MaskOf(of));
  }

  // False if it was there already.
  bool Place(const Pose& T_world_group) {
    const Eigen::Matrix4f matrix = T_world_group.matrix().cast<float>();
    if (placed && matrix == T_world_group_last) return false;
    placed = true;
    T_world_group_last = matrix;
    R_world_group = matrix.topLeftCorner<3, 3>();
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, matrix.data());
    rtcCommitGeometry(geometry.get());
    return true;
  }
};

constexpr int kPacket = 8;
constexpr float kBoundMargin_m = 1e-2f;
constexpr std::size_t kBoundsMax = 8;  // with more instances, Embree's own hierarchy is faster

// Eight rays in Embree's form. Lanes beyond count repeat the first ray and are not valid.
template <class Packet>
void Fill(Packet& ray, std::span<const Ray> rays, Panes panes) {
  for (std::size_t i = 0; i < kPacket; ++i) {
    const Ray& from = rays[i < rays.size() ? i : 0];
    ray.org_x[i] = from.origin.x();
    ray.org_y[i] = from.origin.y();
    ray.org_z[i] = from.origin.z();
    ray.dir_x[i] = from.direction.x();
    ray.dir_y[i] = from.direction.y();
    ray.dir_z[i] = from.direction.z();
    ray.tnear[i] = 0.0f;
    ray.tfar[i] = from.max_range_m;
    ray.time[i] = 0.0f;
    ray.mask[i] = panes == Panes::kSeen ? kOpaqueMask | kPaneMask : kOpaqueMask;
    ray.id[i] = ray.flags[i] = 0;
  }
}

// A bounding sphere of an instance, world frame. Most packets of rays miss all spheres, which is cheaper to test here
// than in Embree.
struct Bound {
  Eigen::Vector3f middle{0, 0, 0};
  float radius_m = 0.0f;

  // Whether one of eight rays may hit it within its range; true if rounding leaves a doubt.
  template <class Packet>
  bool MayMeet(const Packet& ray) const {
    const float cx = middle.x(), cy = middle.y(), cz = middle.z(), reach_m = radius_m + kBoundMargin_m;
    int meets = 0;
    for (std::size_t i = 0; i < kPacket; ++i) {
      const float tx = cx - ray.org_x[i], ty = cy - ray.org_y[i], tz = cz - ray.org_z[i];
      const float along = tx * ray.dir_x[i] + ty * ray.dir_y[i] + tz * ray.dir_z[i];
      const float px = tx - along * ray.dir_x[i], py = ty - along * ray.dir_y[i], pz = tz - along * ray.dir_z[i];
      meets |=
          (px * px + py * py + pz * pz <= reach_m * reach_m) & (along >= -reach_m) & (along - reach_m <= ray.tfar[i]);
    }
    return meets != 0;
  }
};

struct Lanes {
  explicit Lanes(std::size_t count) {
    for (std::size_t i = 0; i < kPacket; ++i) valid[i] = i < count ? -1 : 0;
  }
  alignas(32) int valid[kPacket];
};

// Queries: the nearest hits of rays from one origin in similar directions (coherent), and whether anything blocks rays
// to lights (incoherent). Embree 4 takes as arguments what Embree 3 calls a context.
#if MERLIN_EMBREE == 4
void Intersect(const Lanes& lanes, RTCScene scene, RTCRayHit8& packet) {
  RTCRayQueryContext context;
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = &context;
  rtcIntersect8(lanes.valid, scene, &packet, &arguments);
}

void Occlude(const Lanes& lanes, RTCScene scene, RTCRay8& packet) {
  RTCRayQueryContext context;
  rtcInitRayQueryContext(&context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
  arguments.context = &context;
  rtcOccluded8(lanes.valid, scene, &packet, &arguments);
}
#else
RTCIntersectContext Context(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

void Intersect(const Lanes& lanes, RTCScene scene, RTCRayHit8& packet) {
  RTCIntersectContext context = Context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcIntersect8(lanes.valid, scene, &context, &packet);
}

void Occlude(const Lanes& lanes, RTCScene scene, RTCRay8& packet) {
  RTCIntersectContext context = Context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  rtcOccluded8(lanes.valid, scene, &context, &packet);
}
#endif

}  // namespace

// Fixed geoms are in one scene of high quality with only triangles. Moving ones are in a second scene of instances,
// which is empty in most rooms, so that rays there traverse only one hierarchy.
struct RayScene::Impl {
  std::deque<RayGroup> groups;  // Embree keeps their addresses
  EmbreeDevice device{rtcNewDevice(kDeviceConfig)};
  std::map<unsigned, Instance> instances;  // by id of the group
  std::vector<int> first_face;             // of a group
  std::vector<RayGroup::Sphere> spheres;   // the same
  std::vector<int> body_of_geom;
  std::vector<Face> faces;
  EmbreeScene fixed, moving;
  std::vector<Bound> bounds;  // of the instances, at the poses of the last Update
  bool fresh = true;          // not committed yet

  Impl(const mjModel* model, const std::vector<bool>& skip_body, const std::vector<bool>& is_pane)
      : groups(GroupGeoms(model, skip_body, is_pane)),
        body_of_geom(model->geom_bodyid, model->geom_bodyid + model->ngeom) {
    if (!device) throw MachineError("ray casting: Embree cannot be started on this machine");
    fixed = NewScene(device.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(fixed.get(), RTC_BUILD_QUALITY_HIGH);
    moving = NewScene(device.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    for (unsigned number = 0; number < groups.size(); ++number) {
      const RayGroup& group = groups[number];
      first_face.push_back(static_cast<int>(faces.size()));
      spheres.push_back(group.Around());
      faces.resize(faces.size() + group.faces.size());
      if (group.fixed) {
        Attach(device.get(), fixed.get(), group, number);
        SetFaces(number, Pose::Identity());
        continue;
      }
      const Instance& made = instances.try_emplace(number, device.get(), group, number).first->second;
      rtcAttachGeometryByID(moving.get(), made.geometry.get(), number);
    }
    bounds.resize(instances.size());
    rtcCommitScene(fixed.get());
  }

  void SetFaces(unsigned number, const Pose& T_world_group) {
    std::size_t to = static_cast<std::size_t>(first_face[number]);
    for (const RayFace& face : groups[number].faces) {
      const Eigen::Vector3d normal = T_world_group.linear() * face.normal;
      faces[to++] = {face.geom, normal.cast<float>(),
                     static_cast<float>(face.offset_m + normal.dot(T_world_group.translation()))};
    }
  }

  void Update(const BodyMotions& bodies, double dt_s) {
    bool moved = std::exchange(fresh, false);
    std::size_t at = 0;
    for (auto& [number, instance] : instances) {
      Bound& bound = bounds[at++];
      const RayGroup& group = groups[number];
      const Pose T_world_group = bodies[static_cast<std::size_t>(group.body)].At(dt_s) * group.T_body_group;
      if (!instance.Place(T_world_group)) continue;
      SetFaces(number, T_world_group);
      const RayGroup::Sphere& around = spheres[number];
      bound = {(T_world_group * around.middle).cast<float>(), static_cast<float>(around.radius_m)};
      moved = true;
    }
    if (!moved) return;
    rtcCommitScene(moving.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE)
      throw MachineError("ray casting: Embree could not build its scene");
  }

  // Whether the moving geoms need a query after these rays have hit the fixed ones.
  template <class Packet>
  bool MayMeetMoving(const Packet& ray) const {
    return bounds.size() > kBoundsMax ||
           std::ranges::any_of(bounds, [&](const Bound& bound) { return bound.MayMeet(ray); });
  }

  RayHit ReadHit(const RTCRayHit8& packet, std::size_t i, const Eigen::Vector3f& direction_world) const {
    const RTCHit8& hit = packet.hit;
    if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) return {};
    const unsigned number = GroupOf(hit.geomID[i]);
    const RayGroup& group = groups[number];
    RayHit read{.range_m = packet.ray.tfar[i]};
    if (IsCurved(hit.geomID[i])) {
      read.geom = group.curved[hit.primID[i]].geom;
      read.face = kCurvedFace;
      read.normal = Eigen::Vector3f(hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]);
      if (!group.fixed) read.normal = instances.at(number).R_world_group * read.normal;
      read.normal.normalize();
    } else {
      read.face = first_face[number] + group.face_of_triangle[hit.primID[i]];
      const Face& face = faces[static_cast<std::size_t>(read.face)];
      read.geom = face.geom;
      read.normal = face.normal;
    }
    if (read.normal.dot(direction_world) > 0.0f) read.normal = -read.normal;
    return read;
  }
};

RayScene::RayScene(const mjModel* model, const std::vector<bool>& skip_body, const std::vector<bool>& is_pane)
    : impl_(std::make_unique<Impl>(model, skip_body, is_pane)) {
  Update(AtRest(model));
}

RayScene::~RayScene() = default;

std::vector<Mover> RayScene::Movers(const BodyMotions& bodies) const {
  std::vector<Mover> movers;
  for (std::size_t number = 0; number < impl_->groups.size(); ++number) {
    const RayGroup& group = impl_->groups[number];
    const BodyMotion& body = bodies[static_cast<std::size_t>(group.body)];
    if (body.still()) continue;
    const RayGroup::Sphere& around = impl_->spheres[number];
    const BodyMotion middle = body.Of(group.T_body_group * Pose(Eigen::Translation3d(around.middle)));
    movers.push_back({group.body, middle.T_world_body.translation(), around.radius_m,
                      middle.velocity_m_s.norm() + middle.angular_velocity_rad_s.norm() * around.radius_m});
  }
  return movers;
}

int RayScene::BodyOf(int geom) const { return impl_->body_of_geom[static_cast<std::size_t>(geom)]; }

const std::vector<Face>& RayScene::faces() const { return impl_->faces; }

void RayScene::Update(const BodyMotions& bodies, double dt_s) { impl_->Update(bodies, dt_s); }

void RayScene::Cast(std::span<const Ray> rays, std::span<RayHit> hits, Panes panes) const {
  assert(rays.size() == hits.size());
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::span<const Ray> some = rays.subspan(first, std::min<std::size_t>(kPacket, rays.size() - first));
    const Lanes lanes(some.size());
    RTCRayHit8 packet;
    Fill(packet.ray, some, panes);
    std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
    Intersect(lanes, impl_->fixed.get(), packet);
    if (impl_->MayMeetMoving(packet.ray)) Intersect(lanes, impl_->moving.get(), packet);
    for (std::size_t i = 0; i < some.size(); ++i) hits[first + i] = impl_->ReadHit(packet, i, some[i].direction);
  }
}

void RayScene::Occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked, Panes panes) const {
  assert(rays.size() == blocked.size());
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::span<const Ray> some = rays.subspan(first, std::min<std::size_t>(kPacket, rays.size() - first));
    const Lanes lanes(some.size());
    RTCRay8 packet;
    Fill(packet, some, panes);
    Occlude(lanes, impl_->fixed.get(), packet);
    if (impl_->MayMeetMoving(packet)) Occlude(lanes, impl_->moving.get(), packet);
    for (std::size_t i = 0; i < some.size(); ++i) blocked[first + i] = packet.tfar[i] < 0.0f;
  }
}

}  // namespace merlin::sim
