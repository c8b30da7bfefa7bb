#include "sim/ray_scene.h"

#include <embree3/rtcore.h>

#include <cassert>
#include <cstring>
#include <deque>

#include "robot/types/error.h"
#include "sim/ray_group.h"

namespace merlin::sim {
namespace {

// One thread: the scene is small, and its bits must not depend on who builds it. A fixed widest instruction set: the
// same bits on every machine that has it.
constexpr char kDeviceConfig[] = "threads=1,set_affinity=0,max_isa=avx2";
constexpr float kBoundsMargin_m = 1e-4f;  // a curved geom's box must hold it in float, too

enum GeometryId : unsigned { kTriangles = 0, kCurved = 1 };  // of the scene of a group

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

// For single rays: args->N is 1.
void IntersectCurved(const RTCIntersectFunctionNArguments* args) {
  const CurvedGeom& curved = static_cast<const RayGroup*>(args->geometryUserPtr)->curved[args->primID];
  auto& [ray, hit] = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const mjtNum origin[3] = {ray.org_x, ray.org_y, ray.org_z};
  const mjtNum direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
  mjtNum normal[3];
  const float range = static_cast<float>(
      mju_rayGeom(curved.position, curved.rotation, curved.size, origin, direction, curved.type, normal));
  if (!args->valid[0] || range < ray.tnear || range > ray.tfar) return;  // -1: missed
  ray.tfar = range;
  hit.Ng_x = static_cast<float>(normal[0]);
  hit.Ng_y = static_cast<float>(normal[1]);
  hit.Ng_z = static_cast<float>(normal[2]);
  hit.primID = args->primID;
  hit.geomID = args->geomID;
  hit.instID[0] = args->context->instID[0];
}

// Rejects hits of a plane from below; the ray is in the group's frame, which is the plane's.
void SeenFromAboveOnly(const RTCFilterFunctionNArguments* args) {
  if (RTCRayN_dir_z(args->ray, args->N, 0) >= 0.0f) args->valid[0] = 0;
}

Scene NewScene(RTCDevice device, RTCSceneFlags flags) {
  Scene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), flags);
  return scene;
}

void AttachTriangles(RTCDevice device, RTCScene scene, const RayGroup& group) {
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  void* vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(group.vertices[0]), group.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(group.triangles[0]), group.triangles.size());
  std::memcpy(vertices, group.vertices.data(), group.vertices.size() * sizeof(group.vertices[0]));
  std::memcpy(triangles, group.triangles.data(), group.triangles.size() * sizeof(group.triangles[0]));
  if (group.one_sided) rtcSetGeometryIntersectFilterFunction(geometry.get(), SeenFromAboveOnly);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), kTriangles);
}

void AttachCurved(RTCDevice device, RTCScene scene, const RayGroup& group) {
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(group.curved.size()));
  rtcSetGeometryUserData(geometry.get(), const_cast<RayGroup*>(&group));  // read only
  rtcSetGeometryBoundsFunction(geometry.get(), CurvedBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), IntersectCurved);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), kCurved);
}

// A group as Embree has it: a scene of its own, and where it stands.
struct Instance {
  const RayGroup* group;
  Scene scene;
  Geometry geometry;
  Eigen::Matrix3f R_world_group = Eigen::Matrix3f::Identity();

  Instance(RTCDevice device, const RayGroup& of)
      : group(&of),
        scene(NewScene(device, RTC_SCENE_FLAG_ROBUST)),
        geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE)) {
    if (!of.triangles.empty()) AttachTriangles(device, scene.get(), of);
    if (!of.curved.empty()) AttachCurved(device, scene.get(), of);
    rtcCommitScene(scene.get());
    rtcSetGeometryInstancedScene(geometry.get(), scene.get());
    Place(Pose::Identity());
  }

  void Place(const Pose& T_world_body) {
    const Eigen::Matrix4f T_world_group = (T_world_body * group->T_body_group).matrix().cast<float>();
    R_world_group = T_world_group.topLeftCorner<3, 3>();
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, T_world_group.data());
    rtcCommitGeometry(geometry.get());
  }
};

}  // namespace

struct RayScene::Impl {
  std::deque<RayGroup> groups;  // Embree keeps their addresses
  Device device{rtcNewDevice(kDeviceConfig)};
  std::vector<Instance> instances;  // [instance id]
  Scene top;

  Impl(const mjModel* model, const std::vector<bool>& skip_body) : groups(GroupGeoms(model, skip_body)) {
    if (!device) throw MachineError("ray casting: Embree cannot be started on this machine");
    top = NewScene(device.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    for (const RayGroup& group : groups) {
      const auto id = static_cast<unsigned>(instances.size());
      instances.emplace_back(device.get(), group);
      rtcAttachGeometryByID(top.get(), instances.back().geometry.get(), id);
    }
  }

  void Commit() {
    rtcCommitScene(top.get());
    if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) {
      throw MachineError("ray casting: Embree could not build its scene");
    }
  }

  RayHit ReadHit(const RTCRayHit& ray, const Eigen::Vector3f& direction_world) const {
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const Instance& instance = instances[ray.hit.instID[0]];
    const RayGroup& group = *instance.group;
    const unsigned primitive = ray.hit.primID;
    const Eigen::Vector3f normal_group(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    const Eigen::Vector3f normal = (instance.R_world_group * normal_group).normalized();
    return {.range_m = ray.ray.tfar,
            .geom = ray.hit.geomID == kTriangles ? group.geom_of_triangle[primitive] : group.curved[primitive].geom,
            .normal = normal.dot(direction_world) > 0.0f ? Eigen::Vector3f(-normal) : normal};
  }
};

RayScene::RayScene(const mjModel* model, const std::vector<bool>& skip_body)
    : impl_(std::make_unique<Impl>(model, skip_body)) {
  Update({ReferencePoses(model)});
}

RayScene::~RayScene() = default;

BodyPoses RayScene::Snapshot(const mjModel* model, const mjData* data) {
  BodyPoses poses;
  for (int b = 0; b < model->nbody; ++b) poses.T_world_body.push_back(ToPose(data->xpos + 3 * b, data->xquat + 4 * b));
  return poses;
}

void RayScene::Update(const BodyPoses& poses) {
  for (Instance& instance : impl_->instances) {
    instance.Place(poses.T_world_body[static_cast<std::size_t>(instance.group->body)]);
  }
  impl_->Commit();
}

void RayScene::Cast(const Eigen::Vector3d& origin_world, std::span<const Eigen::Vector3f> directions_world,
                    std::span<RayHit> hits, float max_range_m) const {
  assert(directions_world.size() == hits.size());
  const Eigen::Vector3f origin = origin_world.cast<float>();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Eigen::Vector3f& direction = directions_world[i];
    RTCRayHit ray{};
    ray.ray.org_x = origin.x();
    ray.ray.org_y = origin.y();
    ray.ray.org_z = origin.z();
    ray.ray.dir_x = direction.x();
    ray.ray.dir_y = direction.y();
    ray.ray.dir_z = direction.z();
    ray.ray.tfar = max_range_m;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->top.get(), &context, &ray);
    hits[i] = impl_->ReadHit(ray, direction);
  }
}

}  // namespace merlin::sim
