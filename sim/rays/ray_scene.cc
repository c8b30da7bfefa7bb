#include "sim/rays/ray_scene.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <utility>

#include "robot/base/error.h"
#include "sim/rays/embree.h"
#include "sim/rays/ray_group.h"

namespace merlin::sim {
namespace {

// One thread: the scene is small, and its bits must not depend on who builds it. A fixed widest instruction set: the
// same bits on every machine that has it.
constexpr char kDeviceConfig[] = "threads=1,set_affinity=0,max_isa=avx2";
constexpr float kBoundsMargin_m = 1e-4f;  // a curved geom's box must hold it in float, too

constexpr unsigned kOpaqueMask = 1, kPaneMask = 2;

// Embree's numbers of the g-th group's geometries, in whichever scene they are: 2 g for triangles, 2 g + 1 for curved ones.
constexpr unsigned TrianglesId(unsigned group) { return 2 * group; }
constexpr unsigned CurvedId(unsigned group) { return 2 * group + 1; }
constexpr bool IsCurved(unsigned id) { return id % 2 == 1; }
constexpr unsigned GroupOf(unsigned id) { return id / 2; }

unsigned MaskOf(const RayGroup& group) { return group.panes ? kPaneMask : kOpaqueMask; }

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;
using Geometry = std::unique_ptr<RTCGeometryTy, Release>;

void CurvedBounds(const RTCBoundsFunctionArguments* args) {
  const CurvedGeom& curved = static_cast<const RayGroup*>(args->geometryUserPtr)->curved[args->primID];
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(curved.rotation);
  const Eigen::Vector3f centre = Eigen::Map<const Eigen::Vector3d>(curved.position).cast<float>();
  const Eigen::Vector3f half = (R.cwiseAbs() * HalfEdges(curved)).cast<float>().array() + kBoundsMargin_m;
  const Eigen::Vector3f low = centre - half, high = centre + half;
  *args->bounds_o = {low.x(), low.y(), low.z(), 0.0f, high.x(), high.y(), high.z(), 0.0f};
}

// Range along the ray, or a negative number.
float HitCurved(const CurvedGeom& curved, RTCRayN* rays, unsigned n, unsigned i, mjtNum normal[3]) {
  const mjtNum origin[3] = {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)};
  const mjtNum direction[3] = {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
  const float range = static_cast<float>(
      mju_rayGeom(curved.position, curved.rotation, curved.size, origin, direction, curved.type, normal));
  return range >= RTCRayN_tnear(rays, n, i) && range <= RTCRayN_tfar(rays, n, i) ? range : -1.0f;
}

void IntersectCurved(const RTCIntersectFunctionNArguments* args) {
  const CurvedGeom& curved = static_cast<const RayGroup*>(args->geometryUserPtr)->curved[args->primID];
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    mjtNum normal[3];
    const float range = args->valid[i] ? HitCurved(curved, rays, args->N, i, normal) : -1.0f;
    if (range < 0.0f) continue;
    RTCRayN_tfar(rays, args->N, i) = range;
    RTCHitN_Ng_x(hits, args->N, i) = static_cast<float>(normal[0]);
    RTCHitN_Ng_y(hits, args->N, i) = static_cast<float>(normal[1]);
    RTCHitN_Ng_z(hits, args->N, i) = static_cast<float>(normal[2]);
    RTCHitN_primID(hits, args->N, i) = args->primID;
    RTCHitN_geomID(hits, args->N, i) = args->geomID;
    RTCHitN_instID(hits, args->N, i, 0) = args->context->instID[0];
  }
}

void OccludeByCurved(const RTCOccludedFunctionNArguments* args) {
  const CurvedGeom& curved = static_cast<const RayGroup*>(args->geometryUserPtr)->curved[args->primID];
  for (unsigned i = 0; i < args->N; ++i) {
    mjtNum normal[3];
    if (args->valid[i] && HitCurved(curved, args->ray, args->N, i, normal) >= 0.0f)
      RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
  }
}

// Rejects hits of a plane from below; the ray is in the group's frame, which is the plane's.
void SeenFromAboveOnly(const RTCFilterFunctionNArguments* args) {
  for (unsigned i = 0; i < args->N; ++i)
    if (RTCRayN_dir_z(args->ray, args->N, i) >= 0.0f) args->valid[i] = 0;
}

Scene NewScene(RTCDevice device, RTCSceneFlags flags) {
  Scene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), flags);
  return scene;
}

void AttachTriangles(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned id) {
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  void* vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(group.vertices[0]), group.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(group.triangles[0]), group.triangles.size());
  std::memcpy(vertices, group.vertices.data(), group.vertices.size() * sizeof(group.vertices[0]));
  std::memcpy(triangles, group.triangles.data(), group.triangles.size() * sizeof(group.triangles[0]));
  if (group.one_sided) {
    rtcSetGeometryIntersectFilterFunction(geometry.get(), SeenFromAboveOnly);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), SeenFromAboveOnly);
  }
  rtcSetGeometryMask(geometry.get(), MaskOf(group));
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), id);
}

void AttachCurved(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned id) {
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(group.curved.size()));
  rtcSetGeometryUserData(geometry.get(), const_cast<RayGroup*>(&group));  // read only
  rtcSetGeometryBoundsFunction(geometry.get(), CurvedBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), IntersectCurved);
  rtcSetGeometryOccludedFunction(geometry.get(), OccludeByCurved);
  rtcSetGeometryMask(geometry.get(), MaskOf(group));
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), id);
}

void Attach(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned number) {
  if (!group.triangles.empty()) AttachTriangles(device, scene, group, TrianglesId(number));
  if (!group.curved.empty()) AttachCurved(device, scene, group, CurvedId(number));
}

// A group that moves, or has a frame of its own: a scene of its own, and where it stands.
struct Instance {
  const RayGroup* group;
  Scene scene;
  Geometry geometry;
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

  // False: it stands there already.
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

// Eight rays as Embree takes them; lanes beyond count repeat the first and are not valid.
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

struct Lanes {
  explicit Lanes(std::size_t count) {
    for (std::size_t i = 0; i < kPacket; ++i) valid[i] = i < count ? -1 : 0;
  }
  alignas(32) int valid[kPacket];
};

// Nearest hits of rays from one place in neighbouring directions, which go down the hierarchy together (coherent); and
// whether rays to lights meet anything, each on its own (incoherent). Embree 4 takes as arguments what 3 calls a context.
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

// What is fixed is one scene of best quality, all of triangles of one kind; what moves is another, of instances: most
// rooms have nothing in it, and their rays then meet one hierarchy only.
struct RayScene::Impl {
  std::deque<RayGroup> groups;  // Embree keeps their addresses
  Device device{rtcNewDevice(kDeviceConfig)};
  std::map<unsigned, Instance> instances;  // by the group's number
  std::vector<int> first_face;             // of a group
  std::vector<Face> faces;
  Scene fixed, moving;
  bool has_instances = false, fresh = true;  // fresh: never committed

  Impl(const mjModel* model, const std::vector<bool>& skip_body, const std::vector<bool>& is_pane)
      : groups(GroupGeoms(model, skip_body, is_pane)) {
    if (!device) throw MachineError("ray casting: Embree cannot be started on this machine");
    fixed = NewScene(device.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(fixed.get(), RTC_BUILD_QUALITY_HIGH);
    moving = NewScene(device.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    for (unsigned number = 0; number < groups.size(); ++number) {
      const RayGroup& group = groups[number];
      first_face.push_back(static_cast<int>(faces.size()));
      faces.resize(faces.size() + group.faces.size());
      if (group.fixed) {
        Attach(device.get(), fixed.get(), group, number);
        SetFaces(number, Pose::Identity());
        continue;
      }
      const Instance& made = instances.try_emplace(number, device.get(), group, number).first->second;
      rtcAttachGeometryByID(moving.get(), made.geometry.get(), number);
    }
    has_instances = !instances.empty();
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
    for (auto& [number, instance] : instances) {
      const RayGroup& group = groups[number];
      const Pose T_world_group = bodies[static_cast<std::size_t>(group.body)].At(dt_s) * group.T_body_group;
      if (!instance.Place(T_world_group)) continue;
      SetFaces(number, T_world_group);
      moved = true;
    }
    if (!moved) return;
    rtcCommitScene(moving.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE)
      throw MachineError("ray casting: Embree could not build its scene");
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

bool RayScene::Moves(const BodyMotions& bodies) const {
  return std::ranges::any_of(
      impl_->groups, [&](const RayGroup& group) { return !bodies[static_cast<std::size_t>(group.body)].still(); });
}

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
    if (impl_->has_instances) Intersect(lanes, impl_->moving.get(), packet);
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
    if (impl_->has_instances) Occlude(lanes, impl_->moving.get(), packet);
    for (std::size_t i = 0; i < some.size(); ++i) blocked[first + i] = packet.tfar[i] < 0.0f;
  }
}

}  // namespace merlin::sim
