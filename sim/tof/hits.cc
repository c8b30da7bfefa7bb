#include "sim/tof/hits.h"

#include <algorithm>
#include <cmath>

#include "sim/parallel.h"

namespace merlin::sim {
namespace {

constexpr float kSamePlane_m = 1e-4f;
constexpr float kGrazing = 1e-6f;

// One plane of one geom.
struct Face {
  int geom = -1;
  Eigen::Vector3f normal{0, 0, 0};
  float offset_m = 0.0f;  // normal . p of its points
  bool Same(const Face& other) const {
    return geom >= 0 && geom == other.geom && normal == other.normal &&
           std::abs(offset_m - other.offset_m) < kSamePlane_m;
  }
};

Face FaceOf(const MidHits& mid, std::size_t i) {
  const RayHit& hit = mid.hits[i];
  if (hit.geom < 0) return {};
  return {hit.geom, hit.normal, hit.normal.dot(mid.Point(i))};
}

void MarkPixels(const Optics& optics, MidHits& mid) {
  const std::size_t n = static_cast<std::size_t>(optics.per_pixel);
  std::vector<Face> faces(optics.pixels());
  mid.mixed.assign(optics.pixels(), 0);
  mid.flat.assign(optics.pixels(), 0);
  for (std::size_t p = 0; p < optics.pixels(); ++p) {
    faces[p] = FaceOf(mid, p * n);
    for (std::size_t s = 1; s < n; ++s) {
      const Face other = FaceOf(mid, p * n + s);
      if (faces[p].Same(other) || (faces[p].geom < 0 && other.geom < 0)) continue;
      mid.mixed[p] = 1;
      faces[p] = {};
      break;
    }
  }
  for (int v = 1; v + 1 < optics.height; ++v) {
    for (int u = 1; u + 1 < optics.width; ++u) {
      const std::size_t p = static_cast<std::size_t>(v * optics.width + u), w = static_cast<std::size_t>(optics.width);
      const auto same = [&](std::size_t q) { return faces[p].Same(faces[q]); };
      mid.flat[p] = same(p - 1) && same(p + 1) && same(p - w) && same(p + w) && same(p - w - 1) && same(p - w + 1) &&
                    same(p + w - 1) && same(p + w + 1);
    }
  }
}

int InstantOf(const Optics& optics, std::size_t sub_ray) {
  if (optics.per_pixel == 1) return SubFrame::kInstants / 2;
  return static_cast<int>(sub_ray / kSubRaysPerEdge + sub_ray % kSubRaysPerEdge) % SubFrame::kInstants;
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
  MidHits mid{.T_world_camera = T_world_camera, .rays = {}, .hits = {}, .mixed = {}, .flat = {}};
  const std::size_t row_rays = static_cast<std::size_t>(optics.width) * static_cast<std::size_t>(optics.per_pixel);
  mid.rays.resize(optics.x.size());
  mid.hits.resize(optics.x.size());
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_world_camera.translation().cast<float>();
  ParallelFor(optics.height, threads, [&](int v) {
    const std::size_t first = static_cast<std::size_t>(v) * row_rays;
    for (std::size_t i = first; i < first + row_rays; ++i)
      mid.rays[i] = {.origin = origin, .direction = R * optics.Direction(i)};
    scene.Cast(std::span(mid.rays).subspan(first, row_rays), std::span(mid.hits).subspan(first, row_rays));
  });
  MarkPixels(optics, mid);
  return mid;
}

void RowHits::Resize(std::size_t n) {
  for (auto* values : {&range_m, &normal_x, &normal_y, &normal_z}) values->resize(n);
  geom.resize(n);
}

SubFrameTracer::SubFrameTracer(const RayScene& scene, const Optics& optics, const MidHits& mid,
                               const BodyMotion& camera, const SubFrame& sub_frame, bool reuse)
    : scene_(scene), optics_(optics), mid_(mid), reuse_(reuse) {
  for (std::size_t i = 0; i < SubFrame::kInstants; ++i) {
    const Pose T_world_camera = camera.At(sub_frame.Instant_s(static_cast<int>(i)));
    R_world_camera_[i] = T_world_camera.linear().cast<float>();
    origin_world_[i] = T_world_camera.translation().cast<float>();
  }
}

void SubFrameTracer::FromPlane(std::size_t pixel, const RayHit& hit, const Eigen::Vector3f& point, RowHits& row,
                               std::size_t at) const {
  std::array<Eigen::Vector3f, SubFrame::kInstants> normal;
  std::array<float, SubFrame::kInstants> distance_m;
  for (std::size_t i = 0; i < SubFrame::kInstants; ++i) {
    normal[i] = R_world_camera_[i].transpose() * hit.normal;
    distance_m[i] = hit.normal.dot(point - origin_world_[i]);
  }
  const std::size_t n = static_cast<std::size_t>(optics_.per_pixel);
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t i = static_cast<std::size_t>(InstantOf(optics_, s));
    const float toward = normal[i].dot(optics_.Direction(pixel * n + s));
    Set(row, at + s, hit.geom, distance_m[i] / std::min(toward, -kGrazing), normal[i]);
  }
}

void SubFrameTracer::Row(int v, RowHits& row) const {
  const std::size_t n = static_cast<std::size_t>(optics_.per_pixel), width = static_cast<std::size_t>(optics_.width);
  const std::size_t first = static_cast<std::size_t>(v) * width;
  row.Resize(width * n);
  std::vector<Ray> rays;
  std::vector<std::size_t> places;  // in the row
  for (std::size_t u = 0; u < width; ++u) {
    const std::size_t pixel = first + u, middle = pixel * n + n / 2;
    if (reuse_ && mid_.flat[pixel] && !scene_.Moves(mid_.hits[middle].geom)) {
      FromPlane(pixel, mid_.hits[middle], mid_.Point(middle), row, u * n);
      continue;
    }
    for (std::size_t s = 0; s < n; ++s) {
      const std::size_t i = static_cast<std::size_t>(InstantOf(optics_, s));
      rays.push_back({.origin = origin_world_[i], .direction = R_world_camera_[i] * optics_.Direction(pixel * n + s)});
      places.push_back(u * n + s);
    }
  }
  std::vector<RayHit> hits(rays.size());
  scene_.Cast(rays, hits);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    const std::size_t i = static_cast<std::size_t>(InstantOf(optics_, places[r] % n));
    Set(row, places[r], hits[r].geom, hits[r].range_m, R_world_camera_[i].transpose() * hits[r].normal);
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

double PictureMotion_px(const Optics& optics, const BodyMotion& camera, double span_s, double nearest_m) {
  const double turn_rad = camera.angular_velocity_rad_s.norm() + camera.velocity_m_s.norm() / std::max(nearest_m, 1e-3);
  // A pixel is narrowest, seen from the lens, at the picture's edge.
  const double pixel_rad = std::min(2.0 * optics.tan_half_x / optics.width, 2.0 * optics.tan_half_y / optics.height) /
                           (1.0 + optics.tan_half_x * optics.tan_half_x + optics.tan_half_y * optics.tan_half_y);
  return 0.5 * span_s * turn_rad / pixel_rad;
}

}  // namespace merlin::sim
