// Measures how fast the simulated cameras are: the median wall time of a frame while the camera drives through
// corridor_26x21.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace merlin {

struct CameraBench {
  struct Depth {
    std::string model;
    std::string actor{};  // a person who crosses ahead of the camera; empty: nobody does
    int width = 0, height = 0;
    double one_thread_ms = 0.0, threads_ms = 0.0;  // a frame with all effects
    double limit_one_thread_ms = 0.0, limit_two_threads_ms = 0.0;
  };
  struct Color {
    std::string model, gl;
    int width = 0, height = 0;
    double frame_ms = 0.0, limit_ms = 0.0;
  };
  int frames = 100, threads = 2;
  std::vector<Depth> depth{};
  std::optional<Color> color{};
  std::string no_color{};  // why the colour camera could not be measured
  // Rays with normals on one thread: our ray caster, and MuJoCo's mj_multiRay with the same rays.
  double rays_per_s = 0.0, multi_ray_per_s = 0.0;
};

// Returns early, with what it has, when interrupted becomes true.
CameraBench BenchCamera(int threads, const std::atomic<bool>& interrupted);

std::string Table(const CameraBench& bench);
std::string ToJson(const CameraBench& bench);

}  // namespace merlin
