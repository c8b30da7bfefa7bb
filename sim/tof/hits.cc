#include "sim/tof/hits.h"

#include <algorithm>
#include <cmath>

#include "sim/tof/lanes.h"
#include "sim/tof/parallel.h"

namespace merlin::sim {
namespace {

constexpr float kGrazing = 1e-6f;

// Calls take for the sub-rays of one row that have this colour in a chessboard pattern.
template <class Take>
void ForEverySecond(const SubGrid& grid, int y, int color, const Take& take) {
  for (int x = (y + color) % 2; x < grid.width; x += 2) take(x, grid.SubRay(x, y));
}

// The face that all neighbours of a sub-ray share; kCurvedFace if they do not share one.
int SharedFace(const SubGrid& grid, std::span<const RayHit> hits, int x, int y) {
  std::array<std::size_t, 4> neighbours;
  std::size_t count = 0;
  if (x > 0) neighbours[count++] = grid.SubRay(x - 1, y);
  if (x + 1 < grid.width) neighbours[count++] = grid.SubRay(x + 1, y);
  if (y > 0) neighbours[count++] = grid.SubRay(x, y - 1);
  if (y + 1 < grid.height) neighbours[count++] = grid.SubRay(x, y + 1);
  for (std::size_t i = 1; i < count; ++i)
    if (hits[neighbours[i]].face != hits[neighbours[0]].face) return kCurvedFace;
  return count == 0 ? kCurvedFace : hits[neighbours[0]].face;
}

// Casts the rays of these sub-rays.
void CastSome(const RayScene& scene, std::span<const std::size_t> sub_rays, MidHits& mid) {
  std::vector<Ray> rays;
  rays.reserve(sub_rays.size());
  for (const std::size_t i : sub_rays) rays.push_back(mid.rays[i]);
  std::vector<RayHit> hits(rays.size());
  scene.Cast(rays, hits);
  for (std::size_t r = 0; r < sub_rays.size(); ++r) mid.hits[sub_rays[r]] = hits[r];
}

RayHit HitOf(const Face& face, int number, const Ray& ray) {
  const Eigen::Vector3f normal = face.normal.dot(ray.direction) > 0.0f ? Eigen::Vector3f(-face.normal) : face.normal;
  return {Range_m(face, ray.origin, ray.direction), face.geom, number, normal};
}

void MarkMixed(const Optics& optics, MidHits& mid) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel);
  mid.mixed.assign(optics.pixels(), 0);
  for (std::size_t p = 0; p < optics.pixels(); ++p) {
    const int face = mid.hits[optics.SubRay(p, 0)].face;
    for (std::size_t s = 1; s < n; ++s)
      mid.mixed[p] |= face == kCurvedFace || mid.hits[optics.SubRay(p, s)].face != face;
  }
}

int InstantOf(const Optics& optics, std::size_t sub_ray) {
  if (optics.per_pixel == 1) return SubFrame::kInstants / 2;
  return static_cast<int>(sub_ray / kSubRaysPerEdge + sub_ray % kSubRaysPerEdge) % SubFrame::kInstants;
}

// Angle of the narrowest pixel as seen from the lens, which is at the edge of the image.
double NarrowestPixel_rad(const Optics& optics) {
  return std::min(2.0 * optics.tan_half_x / optics.width, 2.0 * optics.tan_half_y / optics.height) /
         (1.0 + optics.tan_half_x * optics.tan_half_x + optics.tan_half_y * optics.tan_half_y);
}

void Set(RowHits& row, std::size_t at, int geom, float range_m, const Eigen::Vector3f& normal_camera) {
  row.range_m[at] = range_m;
  row.normal_x[at] = normal_camera.x();
  row.normal_y[at] = normal_camera.y();
  row.normal_z[at] = normal_camera.z();
  row.geom[at] = geom;
}

}  // namespace

MidHits TraceMid(const RayScene& scene, const Optics& optics, const Pose& T_world_camera, int threads) {
  MidHits mid(optics);
  const SubGrid& grid = mid.grid;
  mid.T_world_camera = T_world_camera;
  mid.rays.resize(optics.x.size());
  mid.hits.resize(optics.x.size());
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_world_camera.translation().cast<float>();
  ParallelFor(optics.height, threads, [&](int v) {
    std::vector<std::size_t> traced;
    traced.reserve(static_cast<std::size_t>(grid.edge * grid.width));
    for (int y = v * grid.edge; y < (v + 1) * grid.edge; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const std::size_t i = grid.SubRay(x, y);
        mid.rays[i] = {.origin = origin, .direction = R * optics.Direction(i)};
      }
      ForEverySecond(grid, y, 0, [&](int, std::size_t i) { traced.push_back(i); });
    }
    CastSome(scene, traced, mid);
  });
  const std::vector<Face>& faces = scene.faces();
  ParallelFor(optics.height, threads, [&](int v) {
    std::vector<std::size_t> traced;
    for (int y = v * grid.edge; y < (v + 1) * grid.edge; ++y) {
      ForEverySecond(grid, y, 1, [&](int x, std::size_t i) {
        const int face = SharedFace(grid, mid.hits, x, y);
        if (face == kCurvedFace)
          traced.push_back(i);
        else if (face != kNoFace)
          mid.hits[i] = HitOf(faces[static_cast<std::size_t>(face)], face, mid.rays[i]);
      });
    }
    CastSome(scene, traced, mid);
  });
  MarkMixed(optics, mid);
  return mid;
}

void RowHits::Resize(std::size_t n) {
  for (auto* values : {&range_m, &normal_x, &normal_y, &normal_z}) values->resize(n);
  geom.resize(n);
}

FramePlan PlanFrame(const Optics& optics, const MidHits& mid, std::span<const std::uint8_t> calm) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel), width = static_cast<std::size_t>(optics.width);
  FramePlan plan;
  std::vector<std::uint8_t> seen;  // [face]
  for (std::size_t v = 0; v < static_cast<std::size_t>(optics.height); ++v) {
    const std::size_t first = v * width * n;
    FramePlan::Row& row = plan.rows.emplace_back();
    row.traced.reserve(n * width);
    for (std::size_t s = 0; s < n && !calm.empty(); ++s) {
      for (std::size_t at = s * width; at < (s + 1) * width; ++at) {
        if (!calm[first + at]) continue;
        const RayHit& hit = mid.hits[first + at];
        if (at > s * width && calm[first + at - 1] && row.calm.back().face == hit.face) {
          ++row.calm.back().end;
          continue;
        }
        row.calm.push_back({at, at + 1, hit.face, hit.geom});
        if (hit.face < 0) continue;
        if (static_cast<std::size_t>(hit.face) >= seen.size()) seen.resize(static_cast<std::size_t>(hit.face) + 1);
        seen[static_cast<std::size_t>(hit.face)] = 1;
      }
    }
    for (std::size_t u = 0; u < width; ++u)
      for (std::size_t at = u; at < n * width; at += width)
        if (calm.empty() || !calm[first + at]) row.traced.push_back(at);
  }
  for (std::size_t face = 0; face < seen.size(); ++face)
    if (seen[face]) plan.faces.push_back(static_cast<int>(face));
  return plan;
}

SubFrameTracer::SubFrameTracer(const RayScene& scene, const Optics& optics, const FramePlan& plan,
                               const BodyMotion& camera, const SubFrame& sub_frame)
    : scene_(scene), optics_(optics), plan_(plan), seen_(scene.faces().size()) {
  for (std::size_t i = 0; i < SubFrame::kInstants; ++i) {
    const Pose T_world_camera = camera.At(sub_frame.Instant_s(static_cast<int>(i)));
    R_world_camera_[i] = T_world_camera.linear().cast<float>();
    origin_world_[i] = T_world_camera.translation().cast<float>();
    for (const int number : plan.faces) {
      const Face& face = scene.faces()[static_cast<std::size_t>(number)];
      const float distance_m = face.normal.dot(origin_world_[i]) - face.offset_m,
                  side = distance_m < 0.0f ? -1.0f : 1.0f;
      seen_[static_cast<std::size_t>(number)][i] = {side * (R_world_camera_[i].transpose() * face.normal),
                                                    side * distance_m};
    }
  }
}

void SubFrameTracer::FromPlane(const FramePlan::Stretch& stretch, const SeenFace& face, std::size_t first,
                               RowHits& row) const {
  const float nx = face.normal_camera.x(), ny = face.normal_camera.y(), nz = face.normal_camera.z();
  const float distance_m = face.distance_m, grazing = kGrazing;
  const float *dx = optics_.x.data() + first, *dy = optics_.y.data() + first, *dz = optics_.z.data() + first;
  float *range_m = row.range_m.data(), *x = row.normal_x.data(), *y = row.normal_y.data(), *z = row.normal_z.data();
  int* geom = row.geom.data();
  MERLIN_SIDE_BY_SIDE
  for (std::size_t at = stretch.begin; at < stretch.end; ++at) {
    const float toward = -(nx * dx[at] + ny * dy[at] + nz * dz[at]);
    range_m[at] = distance_m / (toward > grazing ? toward : grazing);
    x[at] = nx, y[at] = ny, z[at] = nz;
    geom[at] = stretch.geom;
  }
}

void SubFrameTracer::Row(int v, RowHits& row, RowRays& work) const {
  const std::size_t n = static_cast<std::size_t>(optics_.per_pixel), width = static_cast<std::size_t>(optics_.width);
  const std::size_t first = static_cast<std::size_t>(v) * width * n;
  const FramePlan::Row& plan = plan_.rows[static_cast<std::size_t>(v)];
  row.Resize(width * n);
  const SeenFace nothing{.distance_m = -kGrazing};  // gives the range -1: nothing
  for (const FramePlan::Stretch& stretch : plan.calm) {
    const std::size_t instant = static_cast<std::size_t>(InstantOf(optics_, stretch.begin / width));
    FromPlane(stretch, stretch.face < 0 ? nothing : seen_[static_cast<std::size_t>(stretch.face)][instant], first, row);
  }
  work.rays.clear();
  for (const std::size_t at : plan.traced) {
    const std::size_t instant = static_cast<std::size_t>(InstantOf(optics_, at / width));
    work.rays.push_back(
        {.origin = origin_world_[instant], .direction = R_world_camera_[instant] * optics_.Direction(first + at)});
  }
  work.hits.resize(work.rays.size());
  scene_.Cast(work.rays, work.hits);
  for (std::size_t r = 0; r < work.rays.size(); ++r) {
    const std::size_t instant = static_cast<std::size_t>(InstantOf(optics_, plan.traced[r] / width));
    const RayHit& hit = work.hits[r];
    Set(row, plan.traced[r], hit.geom, hit.range_m, R_world_camera_[instant].transpose() * hit.normal);
  }
}

void RowOfMid(const Optics& optics, const MidHits& mid, int v, RowHits& row) {
  const std::size_t count = static_cast<std::size_t>(optics.width) * static_cast<std::size_t>(optics.per_pixel);
  const Eigen::Matrix3f R_camera_world = mid.T_world_camera.linear().transpose().cast<float>();
  row.Resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const RayHit& hit = mid.hits[static_cast<std::size_t>(v) * count + i];
    Set(row, i, hit.geom, hit.range_m, R_camera_world * hit.normal);
  }
}

double PictureMotion_px(const Optics& optics, const RayScene& scene, const MidHits& mid, const Mover& mover,
                        double span_s) {
  // Uses the nearest visible part. If there is none, its bounding sphere: it is hidden, or beside the image.
  float nearest_m = HUGE_VALF;
  for (const RayHit& hit : mid.hits)
    if (hit.geom >= 0 && scene.BodyOf(hit.geom) == mover.body) nearest_m = std::min(nearest_m, hit.range_m);
  double away_m = nearest_m;
  if (!std::isfinite(nearest_m)) {
    const Eigen::Vector3d middle_camera = mid.T_world_camera.inverse() * mover.middle;
    const double distance_m = middle_camera.norm(), radius_m = mover.radius_m + span_s * mover.speed_m_s;
    away_m = distance_m - radius_m;
    if (away_m > 0.0) {
      const double corner_rad = std::atan(std::hypot(optics.tan_half_x, optics.tan_half_y));
      const double off_rad = std::acos(std::clamp(middle_camera.z() / distance_m, -1.0, 1.0));
      if (off_rad - std::asin(radius_m / distance_m) > corner_rad) return 0.0;
    }
  }
  return 0.5 * span_s * (mover.speed_m_s / std::max(away_m, 1e-3)) / NarrowestPixel_rad(optics);
}

double PictureMotion_px(const Optics& optics, const BodyMotion& camera, double span_s, double nearest_m) {
  const double turn_rad = camera.angular_velocity_rad_s.norm() + camera.velocity_m_s.norm() / std::max(nearest_m, 1e-3);
  return 0.5 * span_s * turn_rad / NarrowestPixel_rad(optics);
}

}  // namespace merlin::sim
