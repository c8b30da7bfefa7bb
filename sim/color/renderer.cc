#include "sim/color/renderer.h"

#ifdef __SSSE3__
#include <immintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "robot/base/error.h"
#include "sim/color/gl_context.h"

namespace merlin::sim {
namespace {

constexpr double kNear_m = 0.05;  // beyond the camera's own housing, and nearer than anything it is to see
constexpr double kFar_m = 100.0;

// The edges of the picture as slopes in the optical frame. Pixel centres have integer coordinates, so the picture
// extends from -0.5 to width - 0.5.
struct Slopes {
  double left, right, up, down;  // x / z and y / z
};

Slopes EdgesOf(const CameraModel& camera) {
  return {(-0.5 - camera.cx_px) / camera.fx_px, (camera.width - 0.5 - camera.cx_px) / camera.fx_px,
          (-0.5 - camera.cy_px) / camera.fy_px, (camera.height - 0.5 - camera.cy_px) / camera.fy_px};
}

mjvGLCamera GlCamera(const Pose& T_world_camera, const CameraModel& camera) {
  const Slopes edges = EdgesOf(camera);
  mjvGLCamera gl{};
  for (int i = 0; i < 3; ++i) {
    gl.pos[i] = static_cast<float>(T_world_camera.translation()[i]);
    gl.forward[i] = static_cast<float>(T_world_camera.linear()(i, 2));
    gl.up[i] = static_cast<float>(-T_world_camera.linear()(i, 1));
  }
  gl.frustum_center = static_cast<float>(0.5 * (edges.left + edges.right) * kNear_m);
  gl.frustum_width =
      static_cast<float>(0.5 * (edges.right - edges.left) * kNear_m);  // MuJoCo takes it as half the width
  gl.frustum_top = static_cast<float>(-edges.up * kNear_m);
  gl.frustum_bottom = static_cast<float>(-edges.down * kNear_m);
  gl.frustum_near = static_cast<float>(kNear_m);
  gl.frustum_far = static_cast<float>(kFar_m);
  return gl;
}

// Draws only geoms of groups 0-2: no sites, joints, tendons, contacts or labels.
mjvOption OnlyGeoms() {
  mjvOption option;
  mjv_defaultOption(&option);
  for (auto* group : {option.sitegroup, option.jointgroup, option.tendongroup, option.actuatorgroup})
    std::fill_n(group, mjNGROUP, mjtByte{0});
  return option;
}

// View-frustum culling: removes geoms that cannot be in the picture at any time during the exposure. A corridor has
// hundreds of geoms, of which a camera sees a few dozen.
void DropUnseen(const mjModel* model, const Pose& T_world_camera, const CameraModel& camera, const MotionBound& bound,
                double half_exposure_s, const BodyMotions& bodies, mjvScene& scene) {
  const Slopes edges = EdgesOf(camera);
  const std::array<Eigen::Vector3d, 5> inward{
      Eigen::Vector3d(1, 0, -edges.left).normalized(), Eigen::Vector3d(-1, 0, edges.right).normalized(),
      Eigen::Vector3d(0, 1, -edges.up).normalized(), Eigen::Vector3d(0, -1, edges.down).normalized(),
      Eigen::Vector3d::UnitZ()};
  const Pose T_camera_world = T_world_camera.inverse();
  const auto unseen = [&](const mjvGeom& geom) {
    if (geom.objtype != mjOBJ_GEOM || geom.objid < 0) return false;
    const double radius_m = model->geom_rbound[geom.objid];
    if (radius_m <= 0.0) return false;  // a plane
    const Eigen::Vector3d centre = T_camera_world * Eigen::Vector3d(geom.pos[0], geom.pos[1], geom.pos[2]);
    double moved_m = bound.shift_m + bound.turn_rad * (centre.norm() + radius_m);
    if (!bodies.empty()) {
      const BodyMotion& body = bodies[static_cast<std::size_t>(model->geom_bodyid[geom.objid])];
      const Eigen::Vector3d arm = T_world_camera * centre - body.T_world_body.translation();
      moved_m +=
          half_exposure_s * (body.velocity_m_s.norm() + body.angular_velocity_rad_s.norm() * (arm.norm() + radius_m));
    }
    return std::any_of(inward.begin(), inward.end(),
                       [&](const Eigen::Vector3d& n) { return n.dot(centre) < -radius_m - moved_m - 1e-3; });
  };
  scene.ngeom = static_cast<int>(std::remove_if(scene.geoms, scene.geoms + scene.ngeom, unseen) - scene.geoms);
}

// Sorts near and small geoms first, walls and planes last: the rasteriser then skips most hidden pixels early.
void NearAndSmallFirst(const mjModel* model, const Eigen::Vector3d& eye_world, mjvScene& scene) {
  const auto reach_m = [&](const mjvGeom& geom) {
    const double radius_m = geom.objtype == mjOBJ_GEOM && geom.objid >= 0 ? model->geom_rbound[geom.objid] : 0.0;
    if (radius_m <= 0.0) return HUGE_VAL;
    return (Eigen::Vector3d(geom.pos[0], geom.pos[1], geom.pos[2]) - eye_world).norm() + radius_m;
  };
  std::stable_sort(scene.geoms, scene.geoms + scene.ngeom,
                   [&](const mjvGeom& a, const mjvGeom& b) { return reach_m(a) < reach_m(b); });
}

}  // namespace

RenderSnapshot::RenderSnapshot(const mjModel* model) {
  mjv_defaultScene(&scene);
  mjv_makeScene(model, &scene, model->ngeom + 100);
  for (const int flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_FOG, mjRND_HAZE}) scene.flags[flag] = 0;
}

RenderSnapshot::~RenderSnapshot() { mjv_freeScene(&scene); }

void RenderSnapshot::Take(const mjModel* model, const mjData* data, const Pose& T_world_camera,
                          const CameraModel& camera, const MotionBound& bound, double half_exposure_s,
                          const BodyMotions& bodies) {
  SetCamera(T_world_camera, camera);
  mjvCamera as_set;
  mjv_defaultCamera(&as_set);
  as_set.type = mjCAMERA_USER;
  const mjvOption option = OnlyGeoms();
  // MuJoCo needs a writable mjData for its scratch stack; the state does not change.
  mjv_updateScene(model, const_cast<mjData*>(data), &option, nullptr, &as_set, mjCAT_STATIC | mjCAT_DYNAMIC, &scene);
  DropUnseen(model, T_world_camera, camera, bound, half_exposure_s, bodies, scene);
  NearAndSmallFirst(model, T_world_camera.translation(), scene);
}

std::vector<MovingGeom> RenderSnapshot::MovingGeoms(const mjModel* model, const BodyMotions& bodies) const {
  std::vector<MovingGeom> moving;
  for (int i = 0; i < scene.ngeom && !bodies.empty(); ++i) {
    const mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM || geom.objid < 0) continue;
    const BodyMotion& body = bodies[static_cast<std::size_t>(model->geom_bodyid[geom.objid])];
    if (body.still()) continue;
    Pose T_world_geom = Pose::Identity();
    T_world_geom.translation() = Eigen::Vector3f::Map(geom.pos).cast<double>();
    T_world_geom.linear() = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>::Map(geom.mat).cast<double>();
    moving.push_back({i, body.Of(body.T_world_body.inverse() * T_world_geom)});
  }
  return moving;
}

void RenderSnapshot::Move(const std::vector<MovingGeom>& geoms, double dt_s) {
  for (const MovingGeom& moving : geoms) {
    mjvGeom& geom = scene.geoms[moving.index];
    const Pose T_world_geom = moving.motion.At(dt_s);
    Eigen::Vector3f::Map(geom.pos) = T_world_geom.translation().cast<float>();
    Eigen::Matrix<float, 3, 3, Eigen::RowMajor>::Map(geom.mat) = T_world_geom.linear().cast<float>();
  }
}

void RenderSnapshot::SetCamera(const Pose& T_world_camera, const CameraModel& camera) {
  scene.camera[0] = scene.camera[1] = GlCamera(T_world_camera, camera);  // MuJoCo uses the mean of the stereo pair
}

namespace {

using ReadPixels = void (*)(int x, int y, int width, int height, unsigned format, unsigned type, void* pixels);
constexpr unsigned kGlRgba = 0x1908, kGlUnsignedByte = 0x1401;  // from the OpenGL registry

void BgrOfRgba(const std::uint8_t* rgba, std::size_t pixels, std::uint8_t* bgr) {
  std::size_t i = 0;
#ifdef __SSSE3__
  const __m128i order = _mm_setr_epi8(2, 1, 0, 6, 5, 4, 10, 9, 8, 14, 13, 12, -1, -1, -1, -1);
  for (; i + 6 <= pixels; i += 4)  // writes 16 bytes of which 12 count; the next write overwrites the rest
    _mm_storeu_si128(reinterpret_cast<__m128i*>(bgr + 3 * i),
                     _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(rgba + 4 * i)), order));
#endif
  for (; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) bgr[3 * i + c] = rgba[4 * i + 2 - c];
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(Gl gl) : context(gl) { mjr_defaultContext(&mjr); }
  ~Impl() {
    const GlContext::Current current(context);
    mjr_freeContext(&mjr);
  }
  GlContext context;
  mjrContext mjr;
  mjrRect viewport{};
  std::vector<std::uint8_t> rgba;
  ReadPixels read_pixels = nullptr;
};

Renderer::Renderer(const mjModel* model, const CameraModel& camera, Gl gl) {
  // MuJoCo reads the size and quality of the buffer from the model, so a copy gets ours instead of the room's.
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> copy(mj_copyModel(nullptr, model), &mj_deleteModel);
  copy->vis.global.offwidth = camera.width;
  copy->vis.global.offheight = camera.height;
  copy->vis.quality.offsamples = 0;
  copy->vis.quality.shadowsize = 0;
  impl_ = std::make_unique<Impl>(gl);
  impl_->viewport = {0, 0, camera.width, camera.height};
  impl_->rgba.resize(static_cast<std::size_t>(camera.width) * camera.height * 4);
  impl_->read_pixels = reinterpret_cast<ReadPixels>(impl_->context.Get("glReadPixels"));
  if (impl_->read_pixels == nullptr) throw MachineError(name() + " has no glReadPixels");
  const GlContext::Current current(impl_->context);
  mjr_makeContext(copy.get(), &impl_->mjr, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &impl_->mjr);
  if (impl_->mjr.currentBuffer != mjFB_OFFSCREEN)
    throw MachineError(name() + " gives no offscreen buffer of " + std::to_string(camera.width) + " x " +
                       std::to_string(camera.height));
}

Renderer::~Renderer() = default;

const std::string& Renderer::name() const { return impl_->context.name(); }

void Renderer::Draw(RenderSnapshot& snapshot, std::span<std::uint8_t> bgr) {
  Impl& impl = *impl_;
  const GlContext::Current current(impl.context);
  mjr_setBuffer(mjFB_OFFSCREEN, &impl.mjr);
  mjr_render(impl.viewport, &snapshot.scene, &impl.mjr);
  // Read RGBA, the buffer's own format. mjr_readPixels asks for three bytes per pixel, which Mesa converts one by one.
  const int width = impl.viewport.width, height = impl.viewport.height;
  impl.read_pixels(0, 0, width, height, kGlRgba, kGlUnsignedByte, impl.rgba.data());
  const std::size_t pixels = static_cast<std::size_t>(width);
  for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row)  // GL has the lowest row first
    BgrOfRgba(impl.rgba.data() + (static_cast<std::size_t>(height) - 1 - row) * pixels * 4, pixels,
              bgr.data() + row * pixels * 3);
}

}  // namespace merlin::sim
