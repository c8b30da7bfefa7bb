#include "sim/rays/embree_group.h"

#include <cstring>
#include <limits>

namespace merlin::sim {
namespace {

constexpr float kBoundsMargin_m = 1e-4f;  // so that a curved geom's box holds it in float as well

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

void AttachTriangles(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned id) {
  const EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
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
  const EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(group.curved.size()));
  rtcSetGeometryUserData(geometry.get(), const_cast<RayGroup*>(&group));  // read only
  rtcSetGeometryBoundsFunction(geometry.get(), CurvedBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), IntersectCurved);
  rtcSetGeometryOccludedFunction(geometry.get(), OccludeByCurved);
  rtcSetGeometryMask(geometry.get(), MaskOf(group));
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), id);
}

}  // namespace

EmbreeScene NewScene(RTCDevice device, RTCSceneFlags flags) {
  EmbreeScene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), flags);
  return scene;
}

void Attach(RTCDevice device, RTCScene scene, const RayGroup& group, unsigned number) {
  if (!group.triangles.empty()) AttachTriangles(device, scene, group, TrianglesId(number));
  if (!group.curved.empty()) AttachCurved(device, scene, group, CurvedId(number));
}

}  // namespace merlin::sim
