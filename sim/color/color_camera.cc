#include "sim/color/color_camera.h"

#include <array>
#include <cmath>

namespace merlin::sim {
namespace {

constexpr int kBlurPictures = 8;

// The mean of pictures in linear light.
class Exposure {
 public:
  explicit Exposure(std::size_t values) : sum_(values, 0.0f) {
    for (int value = 0; value < 256; ++value) light_[value] = static_cast<float>(LinearOfSrgb(value) / kBlurPictures);
  }
  void Add(const std::vector<std::uint8_t>& picture) {
    for (std::size_t i = 0; i < picture.size(); ++i) sum_[i] += light_[picture[i]];
  }
  void Write(std::vector<std::uint8_t>& picture) const {
    for (std::size_t i = 0; i < picture.size(); ++i)
      picture[i] = static_cast<std::uint8_t>(SrgbOfLinear(std::fmin(sum_[i], 1.0f)) + 0.5);
  }

 private:
  std::array<float, 256> light_{};
  std::vector<float> sum_;
};

}  // namespace

ColorCamera::ColorCamera(const mjModel* model, const ColorCameraSheet& sheet, Gl gl, std::uint64_t seed,
                         bool motion_blur)
    : sheet_(sheet),
      lens_(sheet.camera),
      renderer_(model, lens_.pinhole(), gl),
      response_(sheet, seed),
      motion_blur_(motion_blur),
      pinhole_bgr_(3 * static_cast<std::size_t>(lens_.pinhole().width) * lens_.pinhole().height) {}

std::shared_ptr<ColorShot> ColorCamera::Take(const mjModel* model, const mjData* data, const BodyMotion& camera,
                                             const BodyMotions& bodies) const {
  auto shot = std::make_shared<ColorShot>(model);
  shot->camera = camera;
  const double half_exposure_s = motion_blur_ ? 0.5 * sheet_.exposure_max_s : 0.0;
  const MotionBound bound{half_exposure_s * camera.velocity_m_s.norm(),
                          half_exposure_s * camera.angular_velocity_rad_s.norm()};
  shot->scene.Take(model, data, camera.T_world_body, lens_.pinhole(), bound, half_exposure_s, bodies);
  if (motion_blur_) shot->moving = shot->scene.MovingGeoms(model, bodies);
  return shot;
}

void ColorCamera::Draw(ColorShot& shot, double exposure_s) {
  if (!motion_blur_ || (shot.camera.still() && shot.moving.empty())) return renderer_.Draw(shot.scene, pinhole_bgr_);
  Exposure exposure(pinhole_bgr_.size());
  for (int i = 0; i < kBlurPictures; ++i) {
    const double dt_s = ((i + 0.5) / kBlurPictures - 0.5) * exposure_s;
    shot.scene.SetCamera(shot.camera.At(dt_s), lens_.pinhole());
    shot.scene.Move(shot.moving, dt_s);
    renderer_.Draw(shot.scene, pinhole_bgr_);
    exposure.Add(pinhole_bgr_);
  }
  exposure.Write(pinhole_bgr_);
}

ColorFrame ColorCamera::Expose(ColorShot& shot, const ColorSettings& settings, Time stamp, std::uint64_t index) {
  if (settings != wanted_) wanted_ = used_ = settings;
  const CameraModel& camera = sheet_.camera;
  ColorFrame frame{stamp, index, used_, camera.width, camera.height, {}};
  frame.bgr.resize(3 * static_cast<std::size_t>(camera.width) * camera.height);
  Draw(shot, used_.exposure_s);
  lens_.Remap(pinhole_bgr_, frame.bgr);
  response_.Expose(frame.bgr, used_, index);
  if (used_.auto_exposure) used_ = NextExposure(sheet_, used_, frame.bgr);
  return frame;
}

}  // namespace merlin::sim
