// The simulated colour camera. A frame takes three steps: MuJoCo draws the picture of a pinhole camera (renderer), the
// picture is distorted (lens), and the sensor adds noise and converts to 8 bits (color_response). Exposure time and
// gain are fixed or automatic.
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

// The data for one picture, taken at the middle of its exposure.
struct ColorShot {
  explicit ColorShot(const mjModel* model) : scene(model) {}
  RenderSnapshot scene;
  BodyMotion camera;               // of the optical frame
  std::vector<MovingGeom> moving;  // for motion blur
};

class ColorCamera {
 public:
  // Throws MachineError if there is no GL. The lens of the data sheet must be invertible. motion_blur: the picture is
  // the mean of eight over the exposure, in which camera and bodies move; it takes eight times as long.
  ColorCamera(const mjModel* model, const ColorCameraSheet& sheet, Gl gl, std::uint64_t seed, bool motion_blur);

  // Takes a snapshot of the world. May run in parallel with Expose. bodies: their motions, for motion blur; empty if
  // all are at rest.
  std::shared_ptr<ColorShot> Take(const mjModel* model, const mjData* data, const BodyMotion& camera,
                                  const BodyMotions& bodies = {}) const;

  // Draws a frame. Call in the order of frames, because automatic exposure depends on the frame before. settings: valid
  // for the data sheet; a change restarts the automatic exposure. May be called from any thread, one at a time.
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
