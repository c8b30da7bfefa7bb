// The colour camera. A frame takes three steps: MuJoCo draws what a pinhole would see (renderer), the picture is distorted
// as the lens does (lens), and the sensor adds noise and converts to 8 bit (color_response). Exposure time and gain are
// fixed or automatic.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "robot/types/color_camera.h"
#include "sim/color/color_response.h"
#include "sim/color/lens.h"
#include "sim/color/renderer.h"
#include "sim/world/motion.h"

namespace merlin::sim {

// What a picture is made of, taken at the middle of its exposure.
struct ColorShot {
  explicit ColorShot(const mjModel* model) : scene(model) {}
  RenderSnapshot scene;
  BodyMotion camera;               // of the optical frame
  std::vector<MovingGeom> moving;  // for motion blur
};

class ColorCamera {
 public:
  // Throws MachineError where there is no GL. The sheet's lens is invertible. motion_blur: the picture is the mean over
  // the exposure, of what a moving camera sees of bodies that move (eight pictures, each at the cost of one).
  ColorCamera(const mjModel* model, const ColorCameraSheet& sheet, Gl gl, std::uint64_t seed, bool motion_blur);

  // Reads the world; safe beside Expose. bodies: how they move, for motion blur; empty: they do not.
  std::shared_ptr<ColorShot> Take(const mjModel* model, const mjData* data, const BodyMotion& camera,
                                  const BodyMotions& bodies = {}) const;

  // In order of frames, because the automatic exposure goes by the frame before. settings: valid for the sheet; others
  // than before start the automatic exposure anew. Any thread, one at a time.
  ColorFrame Expose(ColorShot& shot, const ColorSettings& settings, Time stamp, std::uint64_t index);

  const std::string& gl_name() const { return renderer_.name(); }

 private:
  void Draw(ColorShot& shot, double exposure_s);

  ColorCameraSheet sheet_;
  Lens lens_;
  Renderer renderer_;
  ColorResponse response_;
  bool motion_blur_;
  ColorSettings wanted_, used_;
  std::vector<std::uint8_t> pinhole_bgr_;
};

}  // namespace merlin::sim
